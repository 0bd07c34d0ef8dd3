#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "block_formats.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html, versions 1.0 to 3.0.

namespace posewright {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

struct Header {
  int item = 8;  ///< bytes a number
  std::vector<std::size_t> shape;
  std::size_t data = 0;  ///< offset of the first number
};

std::string_view value_of(std::string_view header, std::string_view key, const SourcePlace& place) {
  const auto at = header.find("'" + std::string(key) + "'");
  const auto colon = at == std::string_view::npos ? at : header.find(':', at);
  if (colon == std::string_view::npos)
    throw InputError(place, "the .npy header has no '" + std::string(key) + "'", "save the array with numpy.save");
  std::string_view rest = header.substr(colon + 1);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  return rest;
}

/// For a message, which keeps to one line.
std::string printable(std::string_view text) {
  std::string result(text.substr(0, 40));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < 0x20 || c > 0x7E; }, '?');
  return result;
}

// What no memory holds, and what a std::size_t of 32 bits cannot count.
constexpr std::uint64_t largest_extent = std::min<std::uint64_t>(std::uint64_t(1) << 40, SIZE_MAX);

std::vector<std::size_t> parse_shape(std::string_view text, const SourcePlace& place) {
  std::vector<std::size_t> shape;
  const auto close = text.find(')');
  if (text.empty() || text.front() != '(' || close == std::string_view::npos)
    throw InputError(place, "the .npy header has no readable shape", "n × r × m is needed");
  const char* p = text.data() + 1;
  const char* end = text.data() + close;
  while (p < end) {
    if (*p == ' ' || *p == ',') {
      ++p;
      continue;
    }
    std::uint64_t extent = 0;
    const auto [next, code] = std::from_chars(p, end, extent);
    if (code != std::errc() || extent > largest_extent)
      throw InputError(place, "the .npy header has no readable shape", "n × r × m is needed");
    shape.push_back(std::size_t(extent));
    p = next;
  }
  return shape;
}

/// Offset of the first number, from the first 12 bytes.
std::size_t header_end(std::string_view bytes, const SourcePlace& place) {
  if (bytes.size() < 12) throw InputError(place, "the .npy header is cut off", "save the array with numpy.save");
  const auto byte = [&](std::size_t i) { return std::size_t(static_cast<unsigned char>(bytes[i])); };
  if (byte(6) == 1) return 10 + byte(8) + 256 * byte(9);
  return 12 + byte(8) + 256 * (byte(9) + 256 * (byte(10) + 256 * byte(11)));
}

Header parse_header(std::string_view bytes, const SourcePlace& place) {
  Header header;
  header.data = header_end(bytes, place);
  if (header.data > bytes.size())
    throw InputError(place, "the .npy header is cut off", "save the array with numpy.save");
  const std::size_t begin = bytes[6] == 1 ? 10 : 12;
  const std::string_view text = bytes.substr(begin, header.data - begin);
  const std::string_view kind = value_of(text, "descr", place);
  if (kind.starts_with("'<f8'")) header.item = 8;
  else if (kind.starts_with("'<f4'")) header.item = 4;
  else
    throw InputError(place, "holds numbers of type " + printable(kind.substr(0, kind.find(','))),
                     "allowed: '<f8', '<f4'");
  if (!value_of(text, "fortran_order", place).starts_with("False"))
    throw InputError(place, "is in Fortran order", "save numpy.ascontiguousarray(array)");
  header.shape = parse_shape(value_of(text, "shape", place), place);
  return header;
}

double number_at(const char* p, int item) {
  if (item == 8) {
    double value;
    std::memcpy(&value, p, 8);
    return value;
  }
  float value;
  std::memcpy(&value, p, 4);
  return value;
}

}  // namespace

static_assert(std::endian::native == std::endian::little, "number_at reads little-endian numbers in place");

bool is_npy(std::string_view bytes) { return bytes.starts_with(magic); }

namespace {

/// n, r and m that the header announces; throws if the file does not hold as many numbers.
std::array<std::size_t, 3> shape_of(const Header& header, std::uintmax_t size, std::optional<int> rows,
                                    const SourcePlace& place) {
  std::size_t n = 0, r = 1, m = 0;
  if (header.shape.size() == 3) {
    n = header.shape[0], r = header.shape[1], m = header.shape[2];
    if (rows && std::size_t(*rows) != r)
      throw InputError(place, "has blocks of " + std::to_string(r) + " rows", "--rows says " + std::to_string(*rows));
  } else if (header.shape.size() == 2) {
    n = count_blocks(header.shape[0], rows, place), r = std::size_t(*rows), m = header.shape[1];
  } else {
    throw InputError(place, "has " + std::to_string(header.shape.size()) + " dimensions",
                     "n × r × m (3) or (n·r) × m (2) is needed");
  }
  if (n == 0 || r == 0 || m == 0) throw InputError(place, "has no blocks", "n, r and m must be at least 1");
  const std::uintmax_t available = (size - header.data) / std::size_t(header.item);
  if (r > 100000 || m > 100000 || available / r / m < n || available != n * r * m)
    throw InputError(place, "holds " + std::to_string(available) + " numbers",
                     std::to_string(n) + " × " + std::to_string(r) + " × " + std::to_string(m) + " are announced");
  return {n, r, m};
}

/// Place of a row, for messages.
struct RowPlace {
  std::size_t block;
  int row;
};

/// A row of an array from the bytes of its numbers.
void fill_numbers(double* row, int columns, const char* bytes, int item, const RowPlace& where,
                  const SourcePlace& place) {
  for (int j = 0; j < columns; ++j) {
    row[j] = number_at(bytes + j * item, item);
    if (!std::isfinite(row[j]))
      throw InputError(place,
                       "block " + std::to_string(where.block) + ", row " + std::to_string(where.row) + ", column " +
                           std::to_string(j) + " is not finite",
                       "all numbers must be finite");
  }
}

}  // namespace

BlockArray parse_npy(std::string_view bytes, std::optional<int> rows, const SourcePlace& place) {
  if (!is_npy(bytes)) throw InputError(place, "is not a .npy array", "save the array with numpy.save");
  const Header header = parse_header(bytes, place);
  const auto [n, r, m] = shape_of(header, bytes.size(), rows, place);
  BlockArray blocks(n, int(r), int(m));
  for (std::size_t i = 0; i < n * r; ++i)
    fill_numbers(blocks.row(i / r, int(i % r)), int(m), bytes.data() + header.data + i * m * std::size_t(header.item),
                 header.item, {i / r, int(i % r)}, place);
  return blocks;
}

namespace {

/// Numbers of a .npy that is read from front to back.
class NpyReader {
 public:
  NpyReader(const std::filesystem::path& path, std::optional<int> rows) : place_{path.string(), 0}, reader_(path) {
    std::string head(12, '\0');
    head.resize(reader_.read(head.data(), head.size()));
    if (!is_npy(head)) throw InputError(place_, "is not a .npy array", "save the array with numpy.save");
    const std::size_t header_size = std::size_t(std::min<std::uintmax_t>(header_end(head, place_), reader_.size()));
    const std::size_t known = head.size();
    head.resize(std::max(known, header_size));
    head.resize(known + reader_.read(head.data() + known, head.size() - known));
    hash_.add(head);
    header_ = parse_header(head, place_);
    const auto [n, r, m] = shape_of(header_, reader_.size(), rows, place_);
    count_ = n;
    rows_ = int(r);
    columns_ = int(m);
    line_.resize(m * std::size_t(header_.item));
  }

  std::size_t count() const { return count_; }
  int rows() const { return rows_; }
  int columns() const { return columns_; }

  void go_to(std::size_t block) { reader_.go_to(header_.data + block * std::size_t(rows_) * line_.size()); }
  /// The next block; its bytes count for the hash.
  void pass() {
    for (int i = 0; i < rows_; ++i) next_line();
  }
  /// Variant for block `to` of an array; `block` is its name in messages.
  void take(BlockArray& blocks, std::size_t to, std::size_t block) {
    for (int i = 0; i < rows_; ++i) {
      next_line();
      fill_row(blocks.row(to, i), i, block);
    }
  }
  std::string hash() { return hash_.hex(); }

 private:
  void next_line() {
    if (reader_.read(line_.data(), line_.size()) != line_.size())
      throw InputError(place_, "is cut off", "it may have changed while it was read");
    hash_.add({line_.data(), line_.size()});
  }
  void fill_row(double* row, int i, std::size_t block) {
    fill_numbers(row, columns_, line_.data(), header_.item, {block, i}, place_);
  }

  SourcePlace place_;
  FileReader reader_;
  Sha256 hash_;
  Header header_;
  std::size_t count_ = 0;
  int rows_ = 0, columns_ = 0;
  std::vector<char> line_;
};

}  // namespace

BlockFile read_npy(const std::filesystem::path& path, std::optional<int> rows) {
  NpyReader reader(path, rows);
  BlockFile file{BlockArray(reader.count(), reader.rows(), reader.columns()), {}, {}};
  for (std::size_t i = 0; i < reader.count(); ++i) reader.take(file.blocks, i, i);
  file.sha256 = reader.hash();
  return file;
}

std::size_t first_of_share(std::size_t total, int rank, int processes) {
  const std::size_t groups = (total + share_group - 1) / share_group;
  return std::min(total, groups * std::size_t(rank) / std::size_t(processes) * share_group);
}

BlockShare read_npy_share(const std::filesystem::path& path, std::optional<int> rows, int rank, int processes,
                          std::size_t spare) {
  NpyReader reader(path, rows);
  BlockShare share;
  share.total = reader.count();
  share.first = first_of_share(share.total, rank, processes);
  share.count = first_of_share(share.total, rank + 1, processes) - share.first;
  share.blocks = BlockArray(share.count + spare, reader.rows(), reader.columns());
  reader.go_to(share.first);
  for (std::size_t i = 0; i < share.count; ++i) reader.take(share.blocks, i, share.first + i);
  if (rank > 0) return share;
  // Process 0 has the first ones: it goes on to the end for the hash.
  for (std::size_t i = share.count; i < share.total; ++i) reader.pass();
  share.sha256 = reader.hash();
  return share;
}

}  // namespace posewright
