// RAPID: CONST jointtarget j1:=[[six],[six]]; MoveAbsJ j1,v100,fine,tool0; a robtarget is [[3],[4],[4],[6]].

#include <algorithm>

#include "pose_form.hpp"
#include "reading.hpp"

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;
using Form = FoundPoint::Form;

bool is_list(const Expression& e, std::size_t items) { return (e.is(Kind::list)) && e.items.size() == items; }

std::optional<FoundPoint> rapid_point(const Expression& list, const Source& source) {
  FoundPoint point{list.line};
  const std::vector<std::string> arm(source.axes.begin(), source.axes.begin() + 6);
  const std::vector<std::string> external(source.axes.begin() + 6, source.axes.end());
  const auto add_external = [&](const Expression& axes) {
    FoundPoint others;
    take_numbers(axes, external, others);
    for (const auto& axis : others.axes)
      if (axis.second.value < 8.9e9) point.axes.push_back(axis);
  };
  if (is_list(list, 2) && is_list(list.items[0], 6) && is_list(list.items[1], 6)) {
    take_numbers(list.items[0], arm, point);
    add_external(list.items[1]);
    return point;
  }
  if (!is_list(list, 4) || !is_list(list.items[0], 3) || !is_list(list.items[1], 4) || !is_list(list.items[2], 4) ||
      !is_list(list.items[3], 6))
    return std::nullopt;
  point.form = Form::pose;
  take_numbers(list.items[0], {"x", "y", "z"}, point);
  take_numbers(list.items[1], {"q1", "q2", "q3", "q4"}, point);
  take_numbers(list.items[2], {"cf1", "cf4", "cf6", "cfx"}, point);
  add_external(list.items[3]);
  return point;
}

bool is_straight(const std::string& word) {
  for (const char* begin :
       {"MOVEL", "TRIGGL", "ARCL", "ARCMOVEL", "SEARCHL", "SPOTL", "SPOTML", "PAINTL", "DISPL", "GLUEL", "CAPL"})
    if (word.starts_with(begin)) return true;
  return false;
}

const Grammar& rapid_grammar() {
  static const char* external = "moves external axes alone";
  static const Grammar rules = {
      {'[', '{', false, false},
      true,
      1,
      is_straight,
      {{{"MOVEABSJ", "MOVEJ",     "MOVEL",     "MOVEJDO",  "MOVELDO",  "MOVEJAO",     "MOVELAO",   "MOVEJGO",
         "MOVELGO",  "MOVEJSYNC", "MOVELSYNC", "TRIGGJ",   "TRIGGL",   "TRIGGABSJ",   "TRIGGJIOS", "TRIGGLIOS",
         "ARCL",     "ARCLSTART", "ARCLEND",   "ARCMOVEL", "ARCMOVEJ", "ARCMOVEABSJ", "SPOTL",     "SPOTJ",
         "SPOTML",   "SPOTMJ",    "PAINTL",    "DISPL",    "GLUEL",    "CAPL"}},
       {{"MOVEC", "MOVECDO", "MOVECAO", "MOVECGO", "MOVECSYNC", "TRIGGC", "ARCC", "ARCCSTART", "ARCCEND", "ARCMOVEC",
         "PAINTC", "DISPC", "CAPC"},
        Role::pose,
        0,
        2},
       {{"SEARCHL"}, Role::pose, 2, 1},
       {{"SEARCHC"}, Role::pose, 2, 2},
       {{"MOVEEXTJ"}, Role::other, 0, 1, external}},
      {"OFFS", "RELTOOL"},
      {"CROBT", "CJOINTT"},
      rapid_point};
  return rules;
}

const LexRules rapid_lexical = {"!", "\"", "_", false};

class Rapid {
 public:
  explicit Rapid(const Source& source)
      : tokens_(tokens_of(source.text, rapid_lexical)),
        cursor_(source.text, tokens_),
        found_(rapid_grammar(), source) {}

  Reading run() {
    while (!cursor_.done()) step();
    if (!found_.reading.remark) found_.reading.remark = RemarkPlace{0, "! "};
    return std::move(found_.reading);
  }

 private:
  void step() {
    if (!cursor_.is_word()) return cursor_.skip();
    const std::string word = upper(cursor_.text());
    if (word == "MODULE") return header();
    if (word == "JOINTTARGET" || word == "ROBTARGET") return declaration();
    if (word == "TOOLDATA" || word == "WOBJDATA") return frame_data(word == "TOOLDATA");
    for (const char* moved : {"PDISPON", "PDISPSET", "EOFFSON", "EOFFSSET"})
      if (word == moved) found_.reading.displaced = std::string(cursor_.text()) + " displaces poses";
    if (word == "PROC" || word == "FUNC" || word == "TRAP") return cursor_.skip_to(")", false);
    if (const Motion* motion = found_.motion(word)) return instruction(motion);
    const bool followed = cursor_.ahead(1).kind == Token::Kind::word || cursor_.ahead(1).is('[', cursor_.source());
    if (followed && !starts_block(word)) return instruction(nullptr);
    assignment();
  }

  static bool starts_block(const std::string& word) {
    static const std::vector<std::string_view> words = {
        "IF",      "ELSEIF",  "ELSE",      "THEN",     "ENDIF", "FOR",   "FROM",     "TO",      "STEP",
        "DO",      "ENDFOR",  "WHILE",     "ENDWHILE", "TEST",  "CASE",  "DEFAULT",  "ENDTEST", "ENDPROC",
        "ENDFUNC", "ENDTRAP", "ENDMODULE", "LOCAL",    "TASK",  "CONST", "PERS",     "VAR",     "RETURN",
        "NOT",     "AND",     "OR",        "XOR",      "ERROR", "UNDO",  "BACKWARD", "RECORD",  "ENDRECORD",
        "ALIAS",   "MOD",     "DIV",       "EXIT",     "RAISE", "RETRY", "TRYNEXT"};
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  /// MODULE name, maybe with attributes in parentheses over several lines.
  void header() {
    cursor_.skip();
    cursor_.skip();
    if (cursor_.sees('(')) {
      cursor_.skip_to(")", false);
      cursor_.take(')');
    }
    if (found_.reading.remark) return;
    const std::string_view text = cursor_.source();
    const std::size_t end = cursor_.before().end, line_end = text.find('\n', end);
    const bool alone = line_end != std::string_view::npos && (cursor_.done() || line_end < cursor_.now().begin);
    found_.reading.remark = alone ? RemarkPlace{line_end + 1, "  ! "} : RemarkPlace{end, "\n  ! "};
  }

  /// jointtarget j1:=…, jointtarget path{3}:=[…]; a parameter of a procedure has no value.
  void declaration() {
    cursor_.skip();
    if (!cursor_.is_word()) return;
    const std::string name(cursor_.text());
    const int line = cursor_.now().line;
    cursor_.skip();
    if (cursor_.sees('{')) {
      cursor_.skip_to("}", false);
      cursor_.take('}');
    }
    if (!cursor_.take(':') || !cursor_.take('=')) return;
    const Expression value = read_expression(cursor_, rapid_grammar().expressions);
    if (!found_.define(name, value, line)) found_.change(name, line, ":=");
  }

  /// tooldata t:=[TRUE,[[…],[…]],[…]], wobjdata w:=[FALSE,TRUE,"",[[…],[…]],[[…],[…]]]: a user and an object frame.
  void frame_data(bool tool) {
    cursor_.skip();
    if (!cursor_.is_word()) return;
    const std::string name = upper(cursor_.text());
    cursor_.skip();
    if (!cursor_.take(':') || !cursor_.take('=')) return;
    const Expression value = read_expression(cursor_, rapid_grammar().expressions);
    const bool held = !value.items.empty() && upper(value.items[0].word) == "TRUE";
    if (tool && held && value.items.size() == 3) {
      if (const auto values = frame_values(value.items[1])) found_.reading.frames[name] = *values;
    } else if (!tool && !held && value.items.size() == 5 && upper(value.items[1].word) == "TRUE") {
      const auto user = frame_values(value.items[3]), object = frame_values(value.items[4]);
      if (user && object)
        found_.reading.frames[name] = rapid_pose().written(rapid_pose().place(*user) * rapid_pose().place(*object));
    }
  }

  static std::optional<std::vector<double>> frame_values(const Expression& pose) {
    std::vector<double> values;
    for (const Expression& part : pose.items)
      for (const Expression& item : part.items)
        if (item.is(Kind::constant)) values.push_back(item.value);
    const bool whole = is_list(pose, 2) && is_list(pose.items[0], 3) && is_list(pose.items[1], 4) && values.size() == 7;
    return whole ? std::optional(values) : std::nullopt;
  }

  /// p1.trans.z := …, p2 := p1, and j1:=[…] of a variable.
  void assignment() {
    const TakenName left = take_name(cursor_, '{', "};", false);
    if (!cursor_.sees(':') || !cursor_.ahead(1).is('=', cursor_.source())) return;
    cursor_.skip();
    cursor_.skip();
    const Expression value = read_expression(cursor_, rapid_grammar().expressions);
    if (left.component || !found_.define(left.name, value, left.line)) {
      found_.change(left.name, left.line, ":=");
      found_.pass(":=", {value}, left.line, Role::operand);
    }
  }

  /// Arguments behind the tool: a signal and its value of MoveLDO, a procedure of MoveLSync.
  static std::size_t behind_tool(const std::string& word) {
    for (const char* ending : {"DO", "AO", "GO"})
      if (word.starts_with("MOVE") && word.ends_with(ending)) return 2;
    return word.starts_with("MOVE") && word.ends_with("SYNC") ? 1 : 0;
  }

  /// Arguments up to the semicolon; \Switch:=value is none of them.
  void instruction(const Motion* motion) {
    const std::string word(cursor_.text());
    const int line = cursor_.now().line;
    cursor_.skip();
    std::vector<Expression> arguments;
    found_.frames = {{}, {"WOBJ0"}};
    while (!cursor_.done() && !cursor_.sees(';')) {
      // IF held MoveL p1,…; has an instruction behind a condition.
      if (cursor_.is_word() && found_.motion(cursor_.text()) != nullptr) break;
      const std::size_t start = cursor_.at;
      if (cursor_.take('\\')) {
        const bool object = upper(cursor_.text()) == "WOBJ";
        cursor_.skip();
        if (cursor_.take(':') && cursor_.take('=')) {
          const Expression value = read_expression(cursor_, rapid_grammar().expressions);
          const bool named = value.is(Kind::name) && !value.component && value.items.empty();
          if (object) found_.frames.base.name = named ? upper(value.word) : "an expression";
        }
        cursor_.take(',');  // \Conc,
      } else if (!cursor_.take(',')) {
        arguments.push_back(read_expression(cursor_, rapid_grammar().expressions));
      }
      if (cursor_.at == start) cursor_.skip();
    }
    const std::size_t behind = behind_tool(upper(word)) + 1;
    if (arguments.size() >= behind && arguments[arguments.size() - behind].is(Kind::name))
      found_.frames.tool.name = upper(arguments[arguments.size() - behind].word);
    if (motion != nullptr) found_.move(*motion, word, arguments, line);
    else found_.pass(word, arguments, line, Role::passed);
  }

  std::vector<Token> tokens_;
  TokenCursor cursor_;
  Collector found_;
};

}  // namespace

Reading read_rapid(const Source& source) { return Rapid(source).run(); }

}  // namespace posewright::programs
