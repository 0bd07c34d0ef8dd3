// URScript: movej([six]), movel(p[six]), q1 = [six] with movej(q1). A pose is of the tool of set_tcp, in the robot's
// base; it states no joints: the controller takes those nearest to the joints where the motion begins, so a motion is
// read with the one that surely ran before it.

#include <algorithm>
#include <set>

#include "pose_form.hpp"
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
      [](const std::string& word) { return word == "MOVEL" || word == "MOVEP"; },
      {{{"movej", "movel", "movep", "servoj", "servoc", "servop"}},
       {{"movec"}, Role::pose, 0, 2},
       {{"speedj", "speedl", "torque_command", "force_mode"}, Role::other, 0, 1, velocity}},
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
    if (block(word)) return;
    if (cursor_.ahead(1).is('(', cursor_.source())) return call();
    if (first && assignment()) return;
    cursor_.skip();
  }

  /// Known place of the robot where a block begins.
  struct Block {
    std::optional<std::size_t> before;
    bool definition = false, moved = false;
  };

  /// Takes a word that begins or ends a block; true if the rest of its line is taken, too.
  bool block(std::string_view word) {
    const bool definition = word == "def" || word == "thread";
    if (definition || word == "if" || word == "while" || word == "for" || word == "switch") {
      blocks_.push_back({last_, definition});
      // A loop begins where its last motion ended as well.
      if (word != "if" && word != "switch") last_.reset();
    } else if (!blocks_.empty() && (word == "elif" || word == "else" || word == "case" || word == "default")) {
      last_ = blocks_.back().before;
    } else if (!blocks_.empty() && word == "end") {
      const Block ended = blocks_.back();
      blocks_.pop_back();
      last_ = ended.moved && !ended.definition ? std::nullopt : ended.before;
      if (ended.moved && !ended.definition) moved();
    }
    if (definition) cursor_.skip_to("", true);
    return definition;
  }

  void moved() {
    if (!blocks_.empty()) blocks_.back().moved = true;
  }

  /// Puts the motions that were found since in their order.
  void follow(std::size_t since, bool along, const std::string& near) {
    std::vector<Use>& uses = found_.reading.uses;
    for (std::size_t i = since; i < uses.size(); ++i) {
      if (!uses[i].moves || uses[i].role == Role::standing) continue;
      uses[i].before = last_;
      uses[i].along = along;
      uses[i].near = near;
      last_ = uses[i].role == Role::pose ? std::optional(i) : std::nullopt;
      moved();
    }
  }

  /// set_tcp(p[…]), set_tcp(tcp)
  void set_tool(const Expression& tool) {
    FoundPoint values;
    take_numbers(tool, urscript_pose().values, values);
    found_.frames.tool = {tool.is(Kind::name) && tool.items.empty() ? tool.word : "an expression"};
    if (!tool.is(Kind::list) || values.axes.size() != 6) return;
    found_.frames.tool = {"set_tcp", std::vector<double>()};
    for (const auto& axis : values.axes) found_.frames.tool.values->push_back(axis.second.value);
  }

  static bool leaves_place_open(std::string_view word) {
    return word == "stopl" || word == "stopj" || word == "freedrive_mode" || word == "teach_mode";
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
      std::string near;
      if (!arguments.empty()) near = take_inverse(arguments[0]);
      const std::size_t before = found_.reading.uses.size();
      found_.move(*motion, word, arguments, line);
      follow(before, word != "movej" && word != "servoj" && near.empty(), near);
      return;
    }
    if (word == "set_tcp" && called.items.size() >= 1) set_tool(called.items[0]);
    if (leaves_place_open(word) || own_.contains(word)) {
      last_.reset();
      moved();
    }
    if (called.is(Kind::call)) {
      found_.pass(word, called.items, line, own_.contains(word) ? Role::passed : Role::operand);
    }
  }

  /// The pose in get_inverse_kin(pose, qnear=joints) in place of the call; name of the joints.
  static std::string take_inverse(Expression& target) {
    if (!target.is(Kind::call) || target.word != "get_inverse_kin" || target.items.empty() || target.items.size() > 2)
      return "";
    std::string near;
    if (target.items.size() == 2) {
      const Expression& given = target.items[1];
      const bool keyword = given.is(Kind::other) && given.items.size() == 2 && given.items[0].word == "qnear";
      const Expression& joints = keyword ? given.items[1] : given;
      if (!joints.is(Kind::name) || !joints.items.empty()) return "";
      near = joints.word;
    }
    target = Expression(target.items[0]);
    return near;
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
      add_frame(name);
      cursor_ = ahead;
      return true;
    }
    found_.change(name, line, "=");
    cursor_ = value_place;  // calls within are seen one by one
    if (value.is(Kind::name)) found_.pass("=", {value}, line, Role::operand);
    return true;
  }

  /// A pose that has a name may be a tool.
  void add_frame(const std::string& name) {
    const FoundPoint& point = found_.reading.points.back();
    if (point.form != Form::pose || point.index || point.axes.size() != 6) return;
    std::vector<double>& values = found_.reading.frames[name];
    values.clear();
    for (const auto& axis : point.axes) values.push_back(axis.second.value);
  }

  std::vector<Token> tokens_;
  TokenCursor cursor_;
  Collector found_;
  std::vector<Block> blocks_;
  std::optional<std::size_t> last_;  ///< motion that surely ended where the next begins
  std::set<std::string, std::less<>> own_;
  bool first_ = true;
};

}  // namespace

Reading read_urscript(const Source& source) { return Urscript(source).run(); }

}  // namespace posewright::programs
