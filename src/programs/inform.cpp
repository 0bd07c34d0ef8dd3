// INFORM: C00000=0,0,0,0,30720,0 of ///POSTYPE PULSE, moved to by MOVJ C00000. C00001=500.0,0.0,300.0,180.0,0.0,0.0 of
// ///RECTAN is a pose in the frame that ///POSTYPE says, with the joints that ///RCONF says, of the tool of ///TOOL.

#include <algorithm>
#include <array>

#include "pose_form.hpp"
#include "posewright/support/trimmed.hpp"
#include "reading.hpp"

namespace posewright::programs {
namespace {

using Form = FoundPoint::Form;

const LexRules inform_lexical = {"", "\"", "_", false};

class Inform {
 public:
  explicit Inform(const Source& source) : source_(source), text_(source.text) {}

  Reading run() {
    int line = 1;
    for (std::size_t begin = 0; begin < text_.size(); ++line) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      read_line(begin, end, line);
      begin = end + 1;
    }
    return std::move(found_);
  }

 private:
  void read_line(std::size_t begin, std::size_t end, int line) {
    const std::string_view text = trimmed(text_.substr(begin, end - begin));
    if (text.starts_with("///")) heading(text);
    if (text.starts_with("//INST")) instructions_ = true;
    if (text == "NOP" && !found_.remark) found_.remark = RemarkPlace{std::min(end + 1, text_.size()), "'", "", 32};
    if (text.empty() || text.front() == '/' || text.front() == '\'') return;
    const std::vector<Token> tokens = tokens_of(text_, inform_lexical, begin, end, line);
    TokenCursor cursor(text_, tokens);
    if (instructions_) return instruction(cursor);
    const std::size_t before = found_.points.size();
    point(cursor);
    if (found_.points.size() > before) {
      found_.points.back().heading.begin = begin;
      found_.points.back().heading.end = std::min(end + 1, text_.size());
    }
  }

  /// Headings hold for the positions below them.
  void heading(std::string_view text) {
    const std::size_t blank = std::min(text.find_first_of(" \t"), text.size());
    const std::string word = upper(text.substr(3, blank - 3));
    const std::string_view value = trimmed(text.substr(blank));
    const std::string_view first = value.substr(0, value.find_first_of(" ,\t"));
    if (word == "PULSE" || word == "RECTAN") pulses_ = word == "PULSE";
    if (word == "TOOL") tool_ = "TOOL " + std::string(first);
    if (word == "USER") user_ = "USER " + std::string(first);
    if (word == "RCONF") {
      heading_ = text;
      configuration(value);
    }
    if (word != "POSTYPE") return;
    kind_ = upper(first);
    pulses_ = kind_ == "PULSE";
  }

  void configuration(std::string_view value) {
    const std::vector<std::string>& names = inform_pose().status;
    status_.clear();
    for (std::size_t begin = 0; begin < value.size() && status_.size() < names.size();) {
      const std::size_t end = std::min(value.find(',', begin), value.size());
      const std::vector<Token> part = tokens_of(value, inform_lexical, begin, end);
      if (part.size() != 2 || part[0].kind != Token::Kind::number) return;
      status_.emplace_back(names[status_.size()], TextNumber{0, 0, part[0].value});
      begin = end + 1;
    }
  }

  /// Headings of a pose.
  void add_headings(FoundPoint& point) const {
    point.axes.insert(point.axes.end(), status_.begin(), status_.end());
    point.heading.text = heading_;
    point.frames.tool.name = tool_.empty() ? "its tool" : tool_;
    if (kind_ == "USER") {
      point.frames.base.name = user_.empty() ? "its user frame" : user_;
    } else if (kind_ == "BASE" || kind_ == "ROBOT") {
      point.frames.base = {kind_, std::vector<double>(6, 0.0)};
    } else if (point.form == Form::pose) {
      point.form = Form::unclear;
      point.why = "is given in " + (kind_.empty() ? "no known" : kind_) + " coordinates";
    }
  }

  /// C00001 and P001 by letter and number; empty: something else.
  static std::string position_name(std::string_view word) {
    const std::string name = upper(word);
    const std::size_t digits = name.find_first_of("0123456789");
    if (digits == std::string::npos || name.find_first_not_of("0123456789", digits) != std::string::npos) return "";
    const std::string letters = name.substr(0, digits);
    if (letters != "C" && letters != "P" && letters != "LP") return "";
    return letters + std::to_string(std::atol(name.c_str() + digits));
  }

  void point(TokenCursor cursor) {
    if (!cursor.is_word()) return;
    const std::string name = position_name(cursor.text());
    if (name.empty() || !cursor.ahead(1).is('=', text_)) return;
    FoundPoint point{cursor.now().line, name, pulses_ ? Form::joints : Form::pose};
    cursor.skip();
    cursor.skip();
    const std::vector<std::string>& names = pulses_ ? source_.axes : inform_pose().values;
    do {
      const Expression value = read_expression(cursor, {});
      if (!value.is(Expression::Kind::constant)) {
        point.form = Form::unclear;
        point.why = "has a value that is no number";
      } else if (point.axes.size() < names.size()) {
        point.axes.emplace_back(names[point.axes.size()], TextNumber{value.begin, value.end, value.value});
      }
    } while (cursor.take(','));
    if (!pulses_) add_headings(point);
    found_.points.push_back(point);
  }

  void instruction(TokenCursor cursor) {
    static constexpr std::array<std::string_view, 6> steps = {"IMOV", "EIMOVL", "EIMOVC", "IMOVJ", "IMOVL", "SIMOV"};
    static constexpr std::array<std::string_view, 8> moves = {"MOVJ",  "MOVL",  "MOVC",  "MOVS",
                                                              "SMOVJ", "SMOVL", "SMOVC", "XMOVL"};
    std::string word;
    bool point_follows = false;
    Role role = Role::operand;
    for (; !cursor.done(); cursor.skip()) {
      if (!cursor.is_word()) continue;
      const std::string now = upper(cursor.text());
      if (now == "SFTON") shifted_ = true;
      if (now == "SFTOF") shifted_ = false;
      const bool move = std::find(moves.begin(), moves.end(), now) != moves.end();
      const bool step = std::find(steps.begin(), steps.end(), now) != steps.end();
      if (move || step) {
        if (point_follows) unclear(word, cursor.now().line);
        word = now;
        // MOVJ C00000 VJ=50.00 +MOVJ C00001 VJ=50.00
        if (cursor.at > 0 && cursor.before().is('+', text_)) {
          found_.uses.push_back({cursor.now().line, word, Role::unclear, "", {}, "moves another robot"});
          point_follows = false;
          role = Role::pose;
          continue;
        }
        point_follows = true;
        role = step ? Role::step : shifted_ ? Role::offset : Role::pose;
        continue;
      }
      if (word.empty()) {
        word = now;
        role = sets(now) ? Role::changed : Role::operand;
        continue;
      }
      const std::string name = position_name(now);
      const bool value = cursor.ahead(1).is('=', text_) || cursor.ahead(1).is('[', text_);
      if (name.empty() || value) {
        if (point_follows && cursor.ahead(1).is('[', text_)) {
          found_.uses.push_back({cursor.now().line, word, Role::unclear, "", {}, "a variable chooses its point"});
          point_follows = false;
        }
        continue;
      }
      if (!point_follows && role != Role::operand && role != Role::changed) continue;
      found_.uses.push_back({cursor.now().line, word, role, name, {}, name});
      found_.uses.back().straight = word == "MOVL";
      point_follows = false;
      if (role == Role::changed) role = Role::operand;
    }
    if (point_follows) unclear(word, cursor.now().line);
  }

  void unclear(const std::string& word, int line) {
    found_.uses.push_back({line, word, Role::unclear, "", {}, "its point is not understood"});
  }

  /// Instructions that give their first operand a value.
  static bool sets(const std::string& word) {
    static constexpr std::array<std::string_view, 9> words = {"SET",   "SETE", "ADD",    "SUB",   "GETS",
                                                              "CNVRT", "MUL",  "MULMAT", "INVMAT"};
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  const Source& source_;
  std::string_view text_;
  Reading found_;
  bool pulses_ = false, instructions_ = false, shifted_ = false;
  std::string kind_, tool_, user_, heading_;  ///< of the positions from here on
  AxisValues status_;
};

}  // namespace

Reading read_inform(const Source& source) { return Inform(source).run(); }

}  // namespace posewright::programs
