#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Position of an attribute's value in a text, between its quotes.
struct XmlAttribute {
  std::string_view name;
  std::size_t begin = 0, end = 0;
};

/// One start tag (or empty element) in a text that is well-formed XML.
struct XmlTag {
  std::string_view name;
  int depth = 0;                     ///< 0: the root element
  std::size_t parent = 0;            ///< index of the tag that it stands in; of the root its own
  std::size_t end = 0;               ///< just behind '>'
  std::size_t after_attributes = 0;  ///< just behind the name or the last attribute
  std::vector<XmlAttribute> attributes;

  const XmlAttribute* find(std::string_view attribute) const;
};

/// All start tags in their order; comments, CDATA, declarations and processing instructions are passed over. tinyxml2
/// tells lines, not bytes.
std::vector<XmlTag> xml_tags(std::string_view text);

}  // namespace posewright
