// URScript: movej([six]), movel(p[six]), q1 = [six] with movej(q1).

#include <algorithm>
#include <set>

#include "reading.hpp"

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;
using Form = FoundPoint::Form;

std::optional<FoundPoint> ur_point(const Expression& list, const Source& source) {
  if (list.items.size() != 6) return std::nullopt;
  FoundPoint point{list.line};
  const bool pose = list.word == "p";
  if (pose) point.form = Form::pose;
  take_numbers(list, pose ? std::vector<std::string>{"x", "y", "z", "rx", "ry", "rz"} : source.axes, point);
  if (!list.is(Kind::list)) {
    point.form = Form::unclear;
    point.why = "has values that are not understood";
  }
  if (point.form == Form::unclear && !pose && point.axes.empty() &&
      std::all_of(list.items.begin(), list.items.end(), [](const Expression& e) { return e.is(Kind::list); }))
    return std::nullopt;  // six points
  return point;
}

const Grammar& urscript_grammar() {
  static const char* velocity = "moves by velocities or forces, to no point";
  static const Grammar rules = {
      {'[', '[', false, true},
      false,
      0,
      nullptr,
      {{"movej"},
       {"movel"},
       {"movep"},
       {"servoj"},
       {"servoc"},
       {"servop"},
       {"movec", Role::pose, 0, 2},
       {"speedj", Role::other, 0, 1, velocity},
       {"speedl", Role::other, 0, 1, velocity},
       {"torque_command", Role::other, 0, 1, velocity},
       {"force_mode", Role::other, 0, 1, velocity}},
      {"pose_trans", "pose_add", "interpolate_pose"},
      {"get_actual_joint_positions", "get_target_joint_positions", "get_actual_tcp_pose", "get_target_tcp_pose"},
      ur_point};
  return rules;
}

const LexRules urscript_lexical = {"#", "\"'", "_", true};

class Urscript {
 public:
  explicit Urscript(const Source& source)
      : tokens_(tokens_of(source.text, urscript_lexical)),
        cursor_(source.text, tokens_),
        found_(urscript_grammar(), source) {
    for (TokenCursor c = cursor_; !c.done(); c.skip())
      if (c.is_word() && (c.text() == "def" || c.text() == "thread")) own_.insert(std::string(c.text(c.ahead(1))));
    const std::size_t end = std::min(source.text.find('\n'), source.text.size());
    const bool function = source.text.starts_with("def ");
    found_.reading.remark = RemarkPlace{function ? std::min(end + 1, source.text.size()) : 0, function ? "  # " : "# "};
  }

  Reading run() {
    while (!cursor_.done()) step();
    return std::move(found_.reading);
  }

 private:
  void step() {
    if (cursor_.now().kind == Token::Kind::line_end || cursor_.sees(';')) first_ = true;
    if (!cursor_.is_word()) return cursor_.skip();
    const std::string_view word = cursor_.text();
    const bool first = std::exchange(first_, word == "global" || word == "local");
    if (word == "def" || word == "thread") return cursor_.skip_to("", true);
    if (cursor_.ahead(1).is('(', cursor_.source())) return call();
    if (first && assignment()) return;
    cursor_.skip();
  }

  /// The arguments may hold further calls: the cursor goes on behind the function's name.
  void call() {
    const std::string word(cursor_.text());
    const int line = cursor_.now().line;
    TokenCursor ahead = cursor_;
    const Expression whole = read_expression(ahead, urscript_grammar().expressions);
    const Expression& called = whole;
    cursor_.skip();
    if (const Motion* motion = found_.motion(word)) {
      std::vector<Expression> arguments = called.is(Kind::call) ? called.items : std::vector<Expression>();
      // movel(pose=p1, …), movej(q=q1)
      for (Expression& argument : arguments)
        if (argument.is(Kind::other) && argument.items.size() == 2 && is_point_keyword(argument.items[0].word))
          argument = Expression(argument.items[1]);
      found_.move(*motion, word, arguments, line);
    } else if (called.is(Kind::call)) {
      found_.pass(word, called.items, line, own_.contains(word) ? Role::passed : Role::operand);
    }
  }

  static bool is_point_keyword(const std::string& word) {
    return word == "q" || word == "pose" || word == "pose_via" || word == "pose_to";
  }

  bool assignment() {
    TokenCursor ahead = cursor_;
    const std::string name(ahead.text());
    const int line = ahead.now().line;
    ahead.skip();
    const bool part = ahead.sees('[');
    while (ahead.sees('[')) {
      ahead.skip_to("]", true);
      ahead.take(']');
    }
    if (!ahead.take('=') || ahead.sees('=')) return false;
    TokenCursor value_place = ahead;
    const Expression value = read_expression(ahead, urscript_grammar().expressions);
    if (!part && found_.define(name, value, line)) {
      cursor_ = ahead;
      return true;
    }
    found_.change(name, line, "=");
    cursor_ = value_place;  // calls within are seen one by one
    if (value.is(Kind::name)) found_.pass("=", {value}, line, Role::operand);
    return true;
  }

  std::vector<Token> tokens_;
  TokenCursor cursor_;
  Collector found_;
  std::set<std::string, std::less<>> own_;
  bool first_ = true;
};

}  // namespace

Reading read_urscript(const Source& source) { return Urscript(source).run(); }

}  // namespace posewright::programs
