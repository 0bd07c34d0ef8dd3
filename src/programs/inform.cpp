// INFORM: C00000=0,0,0,0,30720,0 of ///POSTYPE PULSE, moved to by MOVJ C00000; other kinds of positions are poses.

#include <algorithm>
#include <array>
#include <cstdlib>

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
    if (text.starts_with("///POSTYPE")) pulses_ = text.find("PULSE") != std::string_view::npos;
    if (text == "///PULSE") pulses_ = true;
    if (text.starts_with("///RECTAN")) pulses_ = false;
    if (text.starts_with("//INST")) instructions_ = true;
    if (text == "NOP" && !found_.remark) found_.remark = RemarkPlace{std::min(end + 1, text_.size()), "'", "", 32};
    if (text.empty() || text.front() == '/' || text.front() == '\'') return;
    const std::vector<Token> tokens = tokens_of(text_, inform_lexical, begin, end, line);
    TokenCursor cursor(text_, tokens);
    if (instructions_) instruction(cursor);
    else point(cursor);
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
    static const std::vector<std::string> of_pose = {"X", "Y", "Z", "RX", "RY", "RZ"};
    const std::vector<std::string>& names = pulses_ ? source_.axes : of_pose;
    do {
      const Expression value = read_expression(cursor, {});
      if (!value.is(Expression::Kind::constant)) {
        point.form = Form::unclear;
        point.why = "has a value that is no number";
      } else if (point.axes.size() < names.size()) {
        point.axes.emplace_back(names[point.axes.size()], TextNumber{value.begin, value.end, value.value});
      }
    } while (cursor.take(','));
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
};

}  // namespace

Reading read_inform(const Source& source) { return Inform(source).run(); }

}  // namespace posewright::programs
