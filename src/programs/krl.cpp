// KRL: PTP XP1, PTP {A1 0.0,A2 -90.0,…}; points are in the .dat file of the same name: DECL E6AXIS XP1={…}.

#include <fmt/format.h>

#include <algorithm>

#include "posewright/controller/axis_names.hpp"
#include "reading.hpp"

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;
using Form = FoundPoint::Form;

std::optional<FoundPoint> krl_point(const Expression& list, const Source&) {
  FoundPoint point{list.line};
  bool joints = false, pose = false;
  for (const Expression& item : list.items) {
    const bool axis = std::ranges::find(krl_axis_names(), item.label) != krl_axis_names().end();
    joints = joints || (axis && item.label[0] == 'A');
    pose = pose || item.label == "X" || item.label == "Y" || item.label == "Z";
    if (item.is(Kind::constant)) {
      point.axes.emplace_back(item.label, TextNumber{item.begin, item.end, item.value});
    } else if (axis || pose) {
      point.form = Form::unclear;
      point.why = "has values that only the controller computes";
    }
  }
  // Angles of a pose are called A, B, C.
  if (!joints && !pose) return std::nullopt;
  if (point.form != Form::unclear) point.form = pose ? Form::pose : Form::joints;
  return point;
}

bool is_straight_krl(const std::string& word) { return word == "LIN" || word == "SLIN"; }

const Grammar& krl_grammar() {
  static const char* external = "moves external axes alone";
  static const Grammar rules = {{'{', '[', true, true},
                                true,
                                1,
                                is_straight_krl,
                                {{{"PTP", "SPTP", "LIN", "SLIN", "SPL"}},
                                 {{"CIRC", "SCIRC"}, Role::pose, 0, 2},
                                 {{"PTP_REL", "SPTP_REL", "LIN_REL", "SLIN_REL", "SPL_REL"}, Role::step},
                                 {{"CIRC_REL", "SCIRC_REL"}, Role::step, 0, 2},
                                 {{"ASYPTP"}, Role::other, 0, 1, external}},
                                {},
                                {"$POS_ACT", "$AXIS_ACT", "$AXIS_RET", "$AXIS_FOR", "$POS_RET", "$POS_FOR"},
                                krl_point};
  return rules;
}

const LexRules krl_lexical = {";", "\"'", "_$#", true};

class Krl {
 public:
  explicit Krl(const Source& source)
      : tokens_(tokens_of(source.text, krl_lexical)), cursor_(source.text, tokens_), found_(krl_grammar(), source) {}

  Reading run() {
    while (!cursor_.done()) {
      statement();
      cursor_.skip_to("", true);
      cursor_.skip();
    }
    if (!found_.reading.remark) found_.reading.remark = RemarkPlace{0, ";"};
    return std::move(found_.reading);
  }

 private:
  void statement() {
    while (cursor_.is_word() && !found_.motion(cursor_.text())) {
      const std::string word = upper(cursor_.text());
      if (word == "DEF" || word == "DEFDAT" || word == "DEFFCT") return header();
      if (word == "EXT" || word == "EXTFCT" || word == "SIGNAL") return;
      if (assignment()) return;
      if (cursor_.ahead(1).is('(', cursor_.source())) return call();
      cursor_.skip();
      if (cursor_.sees('.') || cursor_.sees('[')) cursor_.skip_to("=", true);
    }
    if (cursor_.is_word()) motion();
  }

  /// A remark stands after the line that says what the file is.
  void header() {
    cursor_.skip_to("", true);
    if (found_.reading.remark) return;
    const std::size_t end = cursor_.now().kind == Token::Kind::line_end ? cursor_.now().end : cursor_.source().size();
    found_.reading.remark = RemarkPlace{end, ";"};
  }

  /// XP1={…}, XP1[3]={…}, XP1.A1=…, XP1=XP2; the cursor is left where it was if it is none.
  bool assignment() {
    TokenCursor ahead = cursor_;
    const auto [name, line, index, component] = take_name(ahead, '[', "]", true);
    if (!ahead.take('=') || ahead.sees('=')) return false;
    const Expression value = read_expression(ahead, krl_grammar().expressions);
    cursor_ = ahead;
    if (frame(upper(name), index, value)) return true;
    if (component || !found_.define(name, value, line)) {
      found_.change(name, line, "=");
      found_.pass("=", {value}, line, Role::operand);
    }
    return true;
  }

  /// $TOOL=…, $BASE=…, TOOL_DATA[n]={…}, FDAT_ACT=FP1, FP1={TOOL_NO 1,BASE_NO 0,…}, $IPO_MODE=#TCP.
  bool frame(const std::string& name, long index, const Expression& value) {
    FramePair& frames = found_.frames;
    if (name == "$TOOL") {
      frames.tool = named_frame(value);
    } else if (name == "$BASE") {
      frames.base = named_frame(value);
    } else if (name == "FDAT_ACT") {
      frames = {{upper(value.word)}, {upper(value.word)}};
    } else if (name == "$IPO_MODE") {
      if (upper(value.word) == "#TCP") found_.reading.displaced = "the tool is stationary ($IPO_MODE=#TCP)";
    } else if ((name == "TOOL_DATA" || name == "BASE_DATA") && index >= 0) {
      if (const auto values = frame_values(value)) found_.reading.frames[numbered(name, double(index))] = *values;
    } else if (value.is(Kind::list) && !value.items.empty() && value.items[0].label == "TOOL_NO") {
      frame_data(name, value);
    } else {
      return name.starts_with('$');
    }
    return true;
  }

  void frame_data(const std::string& name, const Expression& value) {
    FramePair& frames = found_.reading.frame_data[name];
    for (const Expression& item : value.items) {
      if (item.label == "TOOL_NO") frames.tool.name = numbered("TOOL_DATA", item.value);
      if (item.label == "BASE_NO") frames.base.name = numbered("BASE_DATA", item.value);
    }
  }

  static std::string numbered(const std::string& name, double number) {
    return fmt::format("{}[{}]", name, long(std::clamp(number, -1e6, 1e6)));
  }

  static std::optional<std::vector<double>> frame_values(const Expression& value) {
    std::vector<double> values;
    for (const char* label : {"X", "Y", "Z", "A", "B", "C"})
      for (const Expression& item : value.items)
        if (value.is(Kind::list) && item.label == label && item.is(Kind::constant)) values.push_back(item.value);
    return values.size() == 6 ? std::optional(values) : std::nullopt;
  }

  /// {X …}, TOOL_DATA[1], $NULLFRAME; what only the controller computes has a name that no value is for.
  static FrameName named_frame(const Expression& value) {
    if (auto values = frame_values(value)) return {"{}", values};
    const std::string word = upper(value.word);
    if (value.is(Kind::name) && word == "$NULLFRAME") return {word, std::vector<double>(6, 0.0)};
    if (value.is(Kind::name) && value.items.size() == 1 && value.items[0].is(Kind::constant))
      return {numbered(word, value.items[0].value)};
    return {word.empty() ? "an expression" : word};
  }

  /// BAS(#TOOL,1), BAS(#BASE,0)
  void frame_by_number(const Expression& called) {
    if (upper(called.word) != "BAS" || called.items.size() != 2 || !called.items[1].is(Kind::constant)) return;
    const double number = called.items[1].value;
    if (upper(called.items[0].word) == "#TOOL") found_.frames.tool = {numbered("TOOL_DATA", number)};
    if (upper(called.items[0].word) == "#BASE") found_.frames.base = {numbered("BASE_DATA", number)};
  }

  /// SLIN XP1 WITH $TOOL=STOOL2(FP1),$BASE=SBASE(FP1.BASE_NO)
  void frames_of_statement() {
    for (; !cursor_.done() && cursor_.now().kind != Token::Kind::line_end; cursor_.skip()) {
      const std::string word = cursor_.is_word() ? upper(cursor_.text()) : "";
      if ((word != "$TOOL" && word != "$BASE") || !cursor_.ahead(1).is('=', cursor_.source())) continue;
      TokenCursor ahead = cursor_;
      ahead.skip();
      ahead.skip();
      const Expression value = read_expression(ahead, krl_grammar().expressions);
      const bool data = value.is(Kind::call) && value.items.size() == 1 && value.items[0].is(Kind::name);
      (word == "$TOOL" ? found_.frames.tool : found_.frames.base) =
          data ? FrameName{upper(value.items[0].word)} : named_frame(value);
    }
  }

  void call() {
    const Expression called = read_expression(cursor_, krl_grammar().expressions);
    frame_by_number(called);
    if (called.is(Kind::call)) found_.pass(called.word, called.items, called.line, Role::passed);
  }

  void motion() {
    const std::string_view word = cursor_.text();
    const Motion& motion = *found_.motion(word);
    const int line = cursor_.now().line;
    cursor_.skip();
    std::vector<Expression> arguments;
    do {
      // CIRC aux, end, CA 90
      if (arguments.size() < motion.count) arguments.push_back(read_expression(cursor_, krl_grammar().expressions));
    } while (arguments.size() < motion.count && cursor_.take(','));
    const FramePair before = found_.frames;
    frames_of_statement();
    found_.move(motion, word, arguments, line);
    found_.frames = before;
  }

  std::vector<Token> tokens_;
  TokenCursor cursor_;
  Collector found_;
};

}  // namespace

Reading read_krl(const Source& source) { return Krl(source).run(); }

}  // namespace posewright::programs
