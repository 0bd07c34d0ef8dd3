#include "posewright/support/text_file.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <utility>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

std::string converted(const std::string& text, const std::string& encoding, const SourcePlace& place) {
  const iconv_t converter = ::iconv_open("UTF-8", encoding.c_str());
  // The library marks what it does not know with a pointer of all ones.
  if (converter == iconv_t(-1))  // NOLINT(performance-no-int-to-ptr)
    throw InputError({place.file, 1}, "encoding " + in_quotes(encoding) + " is not known", "UTF-8 is expected");
  std::string result;
  std::string from = text;
  char* in = from.data();
  std::size_t left = from.size();
  std::array<char, 4096> part{};
  bool failed = false;
  while (left > 0 && !failed) {
    char* out = part.data();
    std::size_t room = part.size();
    const std::size_t before = left;
    failed = ::iconv(converter, &in, &left, &out, &room) == std::size_t(-1) && room == part.size() && left == before;
    result.append(part.data(), part.size() - room);
  }
  ::iconv_close(converter);
  if (failed) throw InputError(place, "is not what it declares to be: " + in_quotes(encoding), "save it as UTF-8");
  return result;
}

/// Position of the encoding's name in <?xml … encoding="NAME" …?>, and its length; 0 if none is declared.
std::pair<std::size_t, std::size_t> declared_encoding(std::string_view text) {
  const std::size_t begin = text.substr(0, 10).find("<?xml");
  if (begin == std::string_view::npos) return {};
  const std::string_view declaration = text.substr(0, text.find("?>", begin));
  const std::size_t key = declaration.find("encoding", begin);
  const std::size_t quote = key == std::string_view::npos ? key : declaration.find_first_of("\"'", key);
  if (quote == std::string_view::npos) return {};
  const std::size_t end = declaration.find(declaration[quote], quote + 1);
  return end == std::string_view::npos ? std::pair<std::size_t, std::size_t>() : std::pair(quote + 1, end - quote - 1);
}

}  // namespace

void require_text(std::string_view bytes, const std::string& file) {
  SourcePlace place{file, 1};
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    const unsigned first = static_cast<unsigned char>(bytes.front());
    const bool control = first == 0x7F || (first < 0x20 && first != '\t' && first != '\n' && first != '\r');
    if (length == 0 || control)
      throw InputError(place, fmt::format("byte 0x{:02x} is not text", first), "a text file in UTF-8 is needed");
    if (first == '\n') ++place.line;
    bytes.remove_prefix(length);
  }
}

std::string read_text(const std::filesystem::path& file, std::uintmax_t limit) {
  std::string text = read_file(file, limit);
  require_text(text, file.string());
  return text;
}

std::string read_xml_text(const std::filesystem::path& file, std::uintmax_t limit) {
  const SourcePlace place{file.string(), 0};
  std::string text = read_file(file, limit);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) text = converted(text, "UTF-16", place);
  const auto [at, length] = declared_encoding(text);
  if (length == 0) {
    require_text(text, file.string());
    return text;
  }
  std::string name = text.substr(at, length);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  if (name != "UTF-8") {
    const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return c < 0x80 && (std::isalnum(c) || c == '-' || c == '_' || c == '.');
    });
    if (!plain) throw InputError(place, "declares an unknown encoding: " + in_quotes(name), "save it as UTF-8");
    // UTF-16 is known by its mark and converted already.
    if (name != "UTF-16") text = converted(text, name, place);
    // Converted text is longer or shorter.
    const auto [now_at, now_length] = declared_encoding(text);
    text.replace(now_at, now_length, now_length > 0 ? "UTF-8" : "");
  }
  require_text(text, file.string());
  return text;
}

}  // namespace posewright
