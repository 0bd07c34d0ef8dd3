#include "posewright/support/json.hpp"

namespace posewright {
namespace {

template <class Json>
std::string text_of(const Json& json, JsonLayout layout) {
  constexpr auto handler = Json::error_handler_t::replace;
  if (layout == JsonLayout::one_line) return json.dump(-1, ' ', false, handler);
  return json.dump(1, ' ', false, handler) + "\n";
}

}  // namespace

nlohmann::json parse_json(const std::string& text) { return nlohmann::json::parse(text); }

nlohmann::ordered_json parse_ordered_json(const std::string& text) { return nlohmann::ordered_json::parse(text); }

std::string json_text(const nlohmann::json& json, JsonLayout layout) { return text_of(json, layout); }

std::string json_text(const nlohmann::ordered_json& json, JsonLayout layout) { return text_of(json, layout); }

}  // namespace posewright
