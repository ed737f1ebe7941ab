#include <zlib.h>

#include "app/exports/bytes.h"
#include "app/exports/encode.h"

namespace neve::app::exports {

namespace {

struct NpyForm {
  std::string type;   ///< "<f8"
  std::string shape;  ///< "(12, 3)"
};

/// Padded so that the numbers start at a multiple of 64 bytes.
std::string npy_file(const NpyForm& form, std::string_view numbers) {
  constexpr std::size_t before = 10, alignment = 64;
  std::string header =
      "{'descr': '" + form.type + "', 'fortran_order': False, 'shape': " + form.shape + ", }";
  while ((before + header.size() + 1) % alignment != 0) header += ' ';
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append_little(static_cast<std::uint16_t>(header.size()), bytes);
  bytes += header;
  bytes += numbers;
  return bytes;
}

NpyForm form_of_column(const Column& column, std::size_t rows) {
  static constexpr const char* types[] = {"<f4", "<f8", "<i4"};
  std::string shape = "(" + std::to_string(rows) + ",";
  if (column.components == 3) shape += " 3";
  if (column.components == 9) shape += " 3, 3";
  return {types[column.numbers.index()], shape + ")"};
}

/// Files of an archive, stored as they are. No date: equal states give equal bytes.
class ZipArchive {
 public:
  void add(const std::string& name, const std::string& bytes) {
    const auto offset = static_cast<std::uint32_t>(bytes_.size());
    std::string common;
    append_little(std::uint16_t{20}, common);  // version that can read it
    append_little(std::uint16_t{0}, common);   // flags
    append_little(std::uint16_t{0}, common);   // stored
    append_little(std::uint16_t{0}, common);   // time
    append_little(first_day, common);
    append_little(checksum(bytes), common);
    append_little(static_cast<std::uint32_t>(bytes.size()), common);
    append_little(static_cast<std::uint32_t>(bytes.size()), common);
    append_little(static_cast<std::uint16_t>(name.size()), common);
    append_little(std::uint16_t{0}, common);  // extra field
    bytes_ += "PK\x03\x04" + common + name + bytes;
    directory_ += std::string("PK\x01\x02") + std::string("\x14\x00", 2) + common;
    directory_ += std::string(10, '\0');  // comment, disk, attributes
    append_little(offset, directory_);
    directory_ += name;
    ++count_;
  }

  std::string take() {
    const auto begin = static_cast<std::uint32_t>(bytes_.size());
    bytes_ += directory_ + "PK\x05\x06" + std::string(4, '\0');
    append_little(count_, bytes_);
    append_little(count_, bytes_);
    append_little(static_cast<std::uint32_t>(directory_.size()), bytes_);
    append_little(begin, bytes_);
    append_little(std::uint16_t{0}, bytes_);
    return std::move(bytes_);
  }

  std::size_t size() const { return bytes_.size(); }

 private:
  static constexpr std::uint16_t first_day = 0x21;  ///< 1 January 1980

  static std::uint32_t checksum(const std::string& bytes) {
    uLong sum = ::crc32_z(0, nullptr, 0);
    sum = ::crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    return static_cast<std::uint32_t>(sum);
  }

  std::string bytes_, directory_;
  std::uint16_t count_ = 0;
};

void add_number(const char* name, double value, ZipArchive& zip) {
  std::string number;
  append_little(value, number);
  zip.add(std::string(name) + ".npy", npy_file({"<f8", "()"}, number));
}

}  // namespace

std::string encode_npz(const ExportMoment& moment) {
  ZipArchive zip;
  for (const Column& column : moment.table.columns) {
    std::string numbers;
    std::visit([&](const auto& list) { append_all(list, numbers); }, column.numbers);
    zip.add(column.name + ".npy", npy_file(form_of_column(column, moment.table.rows), numbers));
  }
  add_number("time", moment.state.time, zip);
  add_number("frame", moment.frame(), zip);
  add_number("fps", moment.scene.fps, zip);
  add_number("scale", moment.spec.scale, zip);
  // UTF-32, as numpy has text.
  const bool is_z = moment.spec.up == scene::UpAxis::z;
  zip.add("up.npy", npy_file({"<U1", "()"}, std::string(is_z ? "z\0\0\0" : "y\0\0\0", 4)));
  return zip.take();
}

}  // namespace neve::app::exports
