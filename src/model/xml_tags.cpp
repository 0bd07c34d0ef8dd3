#include "xml_tags.hpp"

#include <algorithm>

namespace posewright {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::size_t behind(std::string_view text, std::string_view mark, std::size_t from) {
  const std::size_t at = text.find(mark, from);
  return at == std::string_view::npos ? text.size() : at + mark.size();
}

/// Behind a comment, CDATA section, processing instruction or declaration that begins at `at`; `at` if there is
/// none.
std::size_t behind_other(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("<!--")) return behind(text, "-->", at + 4);
  if (rest.starts_with("<![CDATA[")) return behind(text, "]]>", at);
  if (rest.starts_with("<?")) return behind(text, "?>", at);
  if (rest.starts_with("<!")) return behind(text, ">", at);
  return at;
}

/// Reads a start tag; `at` is its '<'. True if it is an empty element.
bool read_tag(std::string_view text, std::size_t at, XmlTag& tag) {
  const auto clip = [&](std::size_t n) { return std::min(n, text.size()); };
  std::size_t here = clip(text.find_first_of(" \t\r\n/>", at));
  tag.name = text.substr(at + 1, here - at - 1);
  tag.after_attributes = here;
  while (true) {
    here = clip(text.find_first_not_of(blanks, here));
    if (here == text.size() || text[here] == '>' || text[here] == '/') break;
    const std::size_t name_end = clip(text.find_first_of(" \t\r\n=", here));
    const std::size_t quote = clip(text.find_first_of("\"'", name_end));
    if (quote == text.size()) return true;
    const std::size_t close = clip(text.find(text[quote], quote + 1));
    tag.attributes.push_back({text.substr(here, name_end - here), quote + 1, close});
    here = tag.after_attributes = clip(close + 1);
  }
  const bool empty = here < text.size() && text[here] == '/';
  tag.end = behind(text, ">", here);
  return empty;
}

}  // namespace

const XmlAttribute* XmlTag::find(std::string_view attribute) const {
  const auto at =
      std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.name == attribute; });
  return at == attributes.end() ? nullptr : &*at;
}

std::vector<XmlTag> xml_tags(std::string_view text) {
  std::vector<XmlTag> tags;
  std::vector<std::size_t> open;
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
    if (const std::size_t next = behind_other(text, at); next != at) {
      at = next;
    } else if (text.substr(at).starts_with("</")) {
      if (!open.empty()) open.pop_back();
      at = behind(text, ">", at);
    } else {
      XmlTag tag;
      const bool empty = read_tag(text, at, tag);
      tag.depth = int(open.size());
      tag.parent = open.empty() ? tags.size() : open.back();
      at = std::max(tag.end, at + 1);
      if (!empty) open.push_back(tags.size());
      tags.push_back(std::move(tag));
    }
  }
  return tags;
}

}  // namespace posewright
