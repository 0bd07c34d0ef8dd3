// trajectory_msgs/JointTrajectory as YAML: positions: [ … ], in the order of joint_names.

#include <fmt/format.h>

#include <algorithm>

#include "posewright/support/error.hpp"
#include "posewright/support/trimmed.hpp"
#include "reading.hpp"

namespace posewright::programs {
namespace {

const LexRules trajectory_lexical = {"#", "\"'", "_", true};

std::string name_of(std::string_view text) {
  std::string name(trimmed(text.substr(0, text.find('#'))));
  std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
  return std::string(trimmed(name));
}

/// Names in brackets, or one a line behind a dash.
std::vector<std::string> names_behind(std::string_view text, std::size_t at) {
  std::vector<std::string> names;
  std::size_t open = text.find_first_not_of(" \t\r\n", at);
  if (open < text.size() && text[open] == '[') {
    const std::size_t close = std::min(text.find(']', open), text.size());
    for (std::size_t begin = open + 1; begin < close;) {
      const std::size_t end = std::min(text.find(',', begin), close);
      names.push_back(name_of(text.substr(begin, end - begin)));
      begin = end + 1;
    }
    return names;
  }
  while (open < text.size() && text[open] == '-') {
    const std::size_t end = std::min(text.find('\n', open), text.size());
    names.push_back(name_of(text.substr(open + 1, end - open - 1)));
    open = text.find_first_not_of(" \t\r\n", end);
  }
  return names;
}

}  // namespace

Reading read_trajectory(const Source& source) {
  const std::vector<Token> tokens = tokens_of(source.text, trajectory_lexical);
  TokenCursor cursor(source.text, tokens);
  std::vector<std::string> names;
  bool named = false;
  Reading reading;
  reading.remark = RemarkPlace{0, "# "};
  for (; !cursor.done(); cursor.skip()) {
    if (!cursor.is_word() || !cursor.ahead(1).is(':', source.text)) continue;
    const std::string key(cursor.text());
    if (key == "joint_names") {
      named = true;
      names = names_behind(source.text, cursor.ahead(1).end);
    }
    if (key != "positions") continue;
    FoundPoint point{cursor.now().line};
    cursor.skip();
    cursor.skip();
    while (cursor.now().kind == Token::Kind::line_end) cursor.skip();
    const Expression values = read_expression(cursor, {});
    take_numbers(values, names, point);
    if (!values.is(Expression::Kind::list) || values.items.size() != names.size() ||
        point.form == FoundPoint::Form::unclear)
      throw InputError({source.file, point.line}, "has positions that are no list in brackets of one number a joint",
                       fmt::format("positions: [{} numbers]", names.size()));
    reading.uses.push_back({point.line, "positions", Role::pose, "", reading.points.size()});
    reading.points.push_back(point);
    if (!cursor.done()) --cursor.at;
  }
  if (!named) throw InputError({source.file, 0}, "has no joint_names", "trajectory_msgs/JointTrajectory");
  return reading;
}

}  // namespace posewright::programs
