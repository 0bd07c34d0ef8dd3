#include "sdf_element.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <numbers>

#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t largest_sdf = 200'000'000;  // bytes

bool is_true(const std::string& text) { return text == "true" || text == "1"; }

Eigen::Matrix3d rotation_of_quaternion(const SdfElement& pose, const std::vector<double>& v) {
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!(std::abs(q.norm() - 1) < 1e-2)) pose.fail("has a quaternion that is not of length 1", "x y z w of a rotation");
  return q.normalized().matrix();
}

}  // namespace

struct SdfElement::Document {
  std::filesystem::path file;
  tinyxml2::XMLDocument xml;
};

SdfElement SdfElement::parse(const std::filesystem::path& file, std::uintmax_t most_bytes, const std::string& needed) {
  const std::string text = read_xml_text(file, most_bytes);
  auto document = std::make_shared<Document>();
  document->file = file;
  if (document->xml.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({file.string(), document->xml.ErrorLineNum()}, "is not well-formed XML", needed);
  const tinyxml2::XMLElement* root = document->xml.RootElement();
  if (root == nullptr) throw InputError({file.string(), 0}, "is empty", needed);
  return {std::move(document), *root};
}

SdfElement SdfElement::open(const std::filesystem::path& file) {
  SdfElement element = parse(file, largest_sdf, "an SDF file is needed");
  if (element.tag() != "sdf" || element.attribute("version").empty())
    element.fail("has the root " + in_quotes(element.tag()), "<sdf version=\"1.4\"> or later is needed");
  return element;
}

const std::filesystem::path& SdfElement::file() const { return document_->file; }
int SdfElement::line() const { return xml_->GetLineNum(); }
std::string SdfElement::tag() const { return xml_->Name(); }

std::string SdfElement::attribute(const char* name) const {
  const char* value = xml_->Attribute(name);
  return value == nullptr ? "" : value;
}

std::string SdfElement::name() const {
  std::string name = attribute("name");
  if (name.empty()) fail("<" + tag() + "> has no name", "name=\"…\" is needed");
  return name;
}

std::optional<SdfElement> SdfElement::child(const char* tag) const {
  const tinyxml2::XMLElement* found = xml_->FirstChildElement(tag);
  if (found == nullptr) return std::nullopt;
  return SdfElement(document_, *found);
}

std::vector<SdfElement> SdfElement::children() const {
  std::vector<SdfElement> list;
  for (const auto* e = xml_->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    list.push_back({document_, *e});
  return list;
}

std::string SdfElement::text() const {
  const char* text = xml_->GetText();
  if (text == nullptr) return "";
  std::string_view all = text;
  const auto first = all.find_first_not_of(" \t\r\n");
  return first == all.npos ? "" : std::string(all.substr(first, all.find_last_not_of(" \t\r\n") - first + 1));
}

std::string SdfElement::text_of(const char* tag) const {
  const auto found = child(tag);
  return found ? found->text() : "";
}

std::vector<double> SdfElement::numbers() const {
  const char* text = xml_->GetText();
  const auto numbers = numbers_in(text == nullptr ? "" : text);
  if (!numbers) fail("<" + tag() + "> holds " + in_quotes(text), "finite numbers separated by blanks are allowed");
  return *numbers;
}

std::vector<double> SdfElement::numbers_of(const char* tag, std::size_t count) const {
  const auto element = child(tag);
  const std::string needed = std::to_string(count) + (count == 1 ? " number is needed" : " numbers are needed");
  if (!element) fail("<" + this->tag() + "> has no <" + tag + ">", needed);
  std::vector<double> values = element->numbers();
  if (values.size() != count) element->fail("<" + std::string(tag) + "> is malformed", needed);
  return values;
}

std::vector<double> SdfElement::lengths_of(const char* tag, std::size_t count) const {
  std::vector<double> values = numbers_of(tag, count);
  if (std::any_of(values.begin(), values.end(), [](double value) { return !(value > 0); }))
    child(tag)->fail("<" + std::string(tag) + "> is not above zero", "lengths in m are needed");
  return values;
}

SdfPose SdfElement::pose() const {
  SdfPose pose;
  const auto element = child("pose");
  if (!element) return pose;
  // Until version 1.6 the attribute was called frame.
  pose.relative_to = element->attribute("relative_to");
  if (pose.relative_to.empty()) pose.relative_to = element->attribute("frame");
  const std::vector<double> v = element->numbers();
  if (v.empty()) return pose;
  const std::string form = element->attribute("rotation_format");
  if (!form.empty() && form != "euler_rpy" && form != "quat_xyzw")
    element->fail("rotation_format is " + in_quotes(form), "euler_rpy, quat_xyzw");
  const bool quaternion = form == "quat_xyzw";
  if (v.size() != (quaternion ? 7U : 6U))
    element->fail("<pose> has " + std::to_string(v.size()) + " numbers",
                  quaternion ? "x y z, then a quaternion x y z w" : "x y z roll pitch yaw");
  pose.X.translation() << v[0], v[1], v[2];
  const double unit = is_true(element->attribute("degrees")) ? std::numbers::pi / 180 : 1;
  pose.X.linear() =
      quaternion ? rotation_of_quaternion(*element, v) : rotation_of_rpy(unit * Eigen::Vector3d(v[3], v[4], v[5]));
  return pose;
}

void SdfElement::fail(const std::string& what, const std::string& allowed) const {
  throw InputError({file().string(), line()}, what, allowed);
}

}  // namespace posewright
