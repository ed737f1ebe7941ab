/// Files go to the page that the program offers them to, once, and no others go anywhere.

#include <sys/stat.h>

#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/view/session/written_files.h"
#include "app/view/web/download.h"
#include "tests/support/temporary_folder.h"
#include "tests/view/web_support.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;
using app::view::web::OpenFile;
using app::view::web::Tickets;

class WebDownload : public Web {
 protected:
  void SetUp() override {
    start();
    page = connect();
  }
  /// The path that the page is told.
  std::string offer(const fs::path& file) {
    front->offer(folder.path(), file);
    for (int k = 0; k < 20; ++k) {
      const auto frame = page->receive(WebClient::text, 3);
      if (!frame) break;
      const app::Json told = app::parse_json(std::string_view(frame->payload));
      if (told.contains("download")) return told["download"];
    }
    ADD_FAILURE() << "the page is told no path";
    return {};
  }
  std::string get(const std::string& path, const std::string& headers = {}) {
    return ask("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers + "\r\n");
  }
  static std::string body_of(const std::string& answer) {
    const std::size_t end = answer.find("\r\n\r\n");
    return end == std::string::npos ? "" : answer.substr(end + 4);
  }

  const TemporaryFolder folder;
  std::unique_ptr<WebClient> page;
};

TEST_F(WebDownload, AnOfferedFileComesWholeAndOnce) {
  std::string bytes;
  for (int k = 0; k < 3'000'000; ++k) bytes += char(k * 7 % 251);
  folder.write("a/picture.png", bytes);
  const std::string path = offer(folder / "a/picture.png");
  EXPECT_TRUE(path.starts_with("/file/") && path.ends_with("/picture.png")) << path;
  EXPECT_EQ(path.find("/a/"), std::string::npos) << "the page learns no folder";
  const std::string answer = get(path);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 OK\r\n")) << answer.substr(0, 200);
  EXPECT_NE(answer.find("Content-Disposition: attachment; filename=\"picture.png\""),
            std::string::npos);
  EXPECT_NE(answer.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_TRUE(body_of(answer) == bytes) << body_of(answer).size() << " bytes";
  EXPECT_TRUE(get(path).starts_with("HTTP/1.1 404")) << "a ticket is used once";
  expect_serving();
}

TEST_F(WebDownload, NothingElseIsGivenToAnybody) {
  folder.write("scene.toml", "frames = 1\n");
  const std::string path = offer(folder / "scene.toml");
  const std::string secret = path.substr(0, path.rfind('/'));
  for (const std::string& other :
       {std::string("/file/"), secret, secret + "/other.toml", secret + "/../scene.toml",
        "/file/" + std::string(32, '0') + "/scene.toml", path + "?token=" + front->token(),
        std::string("/file/scene.toml?token=") + front->token(), "/scene.toml" + target("")}) {
    if (other == path + "?token=" + front->token()) continue;  // the ticket itself
    EXPECT_TRUE(get(other).starts_with("HTTP/1.1 404")) << other;
  }
  EXPECT_TRUE(get(path, "Origin: http://evil.example\r\n").starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(
      ask("GET " + path + " HTTP/1.1\r\nHost: evil.example\r\n\r\n").starts_with("HTTP/1.1 403"));
  EXPECT_FALSE(
      ask("POST " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n").starts_with("HTTP/1.1 200"));
  EXPECT_EQ(body_of(get(path)), "frames = 1\n") << "refusals cost no ticket";
}

TEST_F(WebDownload, OnlyPlainFilesOfTheFolderAreOffered) {
  const TemporaryFolder elsewhere;
  elsewhere.write("secret.txt", "hunter2");
  folder.write("in/file.txt", "mine");
  fs::create_symlink(elsewhere / "secret.txt", folder / "link.txt");
  fs::create_directory_symlink(elsewhere.path(), folder / "door");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const fs::path& file :
       {elsewhere / "secret.txt", folder / "link.txt", folder / "door/secret.txt", folder / "pipe",
        folder / "in", folder / "absent.txt", fs::path("/etc/passwd"),
        folder.path() / ".." / elsewhere.path().filename() / "secret.txt"})
    EXPECT_THROW(OpenFile(folder.path(), file), app::IoError) << file;
  EXPECT_EQ(OpenFile(folder.path(), folder / "in/../in/file.txt").read(99), "mine");
  EXPECT_EQ(OpenFile(folder.path(), folder / "in/file.txt").name(), "file.txt");
  // Such files are not listed either.
  const auto listed = app::view::session::written_files(folder.path());
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0].name, "in/file.txt");
  EXPECT_EQ(listed[0].bytes, 4u);
}

TEST_F(WebDownload, ANameCannotBreakAHeader) {
  EXPECT_EQ(app::view::web::plain_name("a\r\nSet-Cookie: x\".png"), "a__Set-Cookie__x_.png");
  EXPECT_EQ(app::view::web::plain_name("../x"), "_._x");
  EXPECT_EQ(app::view::web::plain_name("0001.png"), "0001.png");
}

TEST_F(WebDownload, TicketsEndAndAreFew) {
  folder.write("file.txt", "x");
  const auto open = [&] { return std::make_unique<OpenFile>(folder.path(), folder / "file.txt"); };
  Tickets tickets;
  const std::string old = tickets.add(open(), 0);
  EXPECT_EQ(tickets.take(old, Tickets::seconds + 1), nullptr);
  std::vector<std::string> paths;
  for (std::size_t k = 0; k <= Tickets::most; ++k) paths.push_back(tickets.add(open(), 100));
  EXPECT_EQ(tickets.take(paths.front(), 101), nullptr) << "the oldest made room";
  EXPECT_NE(tickets.take(paths.back(), 101), nullptr);
  EXPECT_EQ(tickets.take(paths.back(), 101), nullptr);
}

TEST_F(WebDownload, AFileThatShrinksIsNotTakenForWhole) {
  folder.write("file.txt", std::string(1'000'000, 'x'));
  const std::string path = offer(folder / "file.txt");
  fs::resize_file(folder / "file.txt", 10);
  const std::string answer = get(path);
  EXPECT_NE(answer.find("Content-Length: 1000000"), std::string::npos);
  EXPECT_LT(body_of(answer).size(), 1'000'000u);
  expect_serving();
}

}  // namespace
}  // namespace neve::test
