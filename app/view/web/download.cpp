#include "app/view/web/download.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "app/support/errors.h"
#include "app/view/web/web_guard.h"

namespace neve::app::view::web {
namespace {

namespace fs = std::filesystem;

/// Path of an open file, whatever happens meanwhile to the one by which it was opened.
fs::path place_of(int file) {
  std::error_code error;
  return fs::read_symlink("/proc/self/fd/" + std::to_string(file), error);
}

bool is_inside(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

}  // namespace

std::string plain_name(const std::string& name) {
  std::string plain = name;
  for (char& c : plain)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-') c = '_';
  return plain.starts_with('.') ? "_" + plain.substr(1) : plain;
}

OpenFile::OpenFile(const fs::path& folder, const fs::path& file)
    // A pipe with that name would wait for ever.
    : file_(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)),
      name_(plain_name(file.filename().string())) {
  const auto refuse = [&](const std::string& why) {
    throw IoError(file.string() + " cannot be downloaded: " + why, file.string());
  };
  if (file_.get() < 0) refuse(std::strerror(errno));
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0 || !S_ISREG(status.st_mode))
    refuse("it is not a regular file");
  std::error_code error;
  const fs::path allowed = fs::canonical(folder, error);
  if (error || !is_inside(allowed, place_of(file_.get())))
    refuse("only files in " + folder.string() + " can");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::string OpenFile::read(std::size_t most) {
  std::string bytes(most, '\0');
  const ssize_t count = ::read(file_.get(), bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

std::string Tickets::add(std::unique_ptr<OpenFile> file, double now) {
  std::erase_if(tickets_, [&](const Ticket& ticket) { return now >= ticket.end; });
  if (tickets_.size() >= most) tickets_.erase(tickets_.begin());
  std::string path = std::string(download_path) + make_token() + "/" + file->name();
  tickets_.push_back({path, now + seconds, std::move(file)});
  return path;
}

std::unique_ptr<OpenFile> Tickets::take(std::string_view path, double now) {
  for (auto ticket = tickets_.begin(); ticket != tickets_.end(); ++ticket) {
    if (!is_same_secret(ticket->secret, path)) continue;
    std::unique_ptr<OpenFile> file = now < ticket->end ? std::move(ticket->file) : nullptr;
    tickets_.erase(ticket);
    return file;
  }
  return nullptr;
}

}  // namespace neve::app::view::web
