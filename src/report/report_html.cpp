#include <stdexcept>
#include <string_view>

#include "posewright/report/report.hpp"

extern "C" {
extern const char posewright_report_page[];
extern const char posewright_report_page_end[];
}

namespace posewright {
namespace {

constexpr std::string_view slot = "@REPORT_DATA@";
constexpr std::string_view doctype = "<!doctype html>";
// First bytes by which the program knows its own reports again.
constexpr std::string_view mark = "<!-- posewright report -->";

/// JSON inside a <script> element: no byte of it may end the element or begin a comment.
std::string for_script(const std::string& json) {
  std::string text;
  text.reserve(json.size() + json.size() / 64);
  for (const char c : json) {
    if (c == '<') text += "\\u003c";
    else text += c;
  }
  return text;
}

std::string page_with(const std::string& json) {
  const std::string_view page(posewright_report_page, std::size_t(posewright_report_page_end - posewright_report_page));
  const auto at = page.find(slot);
  if (!page.starts_with(doctype) || at == std::string_view::npos)
    throw std::logic_error("the report's page has no place for its data");
  std::string text(doctype);
  text += mark;
  text += page.substr(doctype.size(), at - doctype.size());
  text += for_script(json);
  text += page.substr(at + slot.size());
  return text;
}

}  // namespace

std::string report_html(const Report& report) { return page_with(report_json(report)); }
std::string report_html(const ResultReport& report) { return page_with(report_json(report)); }
std::string report_html(const TwoPlansReport& report) { return page_with(report_json(report)); }
std::string report_html(const ProblemReport& report) { return page_with(report_json(report)); }

}  // namespace posewright
