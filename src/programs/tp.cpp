// TP: 1:J P[1] 20% FINE ; in /MN, P[1]{ GP1: UF : 0, UT : 1, J1= 0.0 deg, … }; in /POS; X = … is a position.

#include <algorithm>
#include <array>

#include "reading.hpp"

namespace posewright::programs {
namespace {

using Form = FoundPoint::Form;

const LexRules tp_lexical = {"", "", "_@", false};

class Tp {
 public:
  explicit Tp(const Source& source) : source_(source), text_(source.text) {}

  Reading run() {
    const std::size_t main = section("/MN"), positions = section("/POS");
    if (main < text_.size()) statements(main, std::min(positions, text_.size()));
    if (positions < text_.size()) points(positions);
    return std::move(found_);
  }

 private:
  /// Begin of the line with a section's name; the text's size if none is.
  std::size_t section(std::string_view name) const {
    for (std::size_t at = text_.find(name); at != std::string_view::npos; at = text_.find(name, at + 1))
      if ((at == 0 || text_[at - 1] == '\n') && (at + name.size() >= text_.size() || !is_word(text_[at + name.size()])))
        return at;
    return text_.size();
  }

  int line_of(std::size_t place) {
    if (place < counted_) {
      counted_ = 0;
      line_ = 1;
    }
    line_ += int(std::count(text_.begin() + long(counted_), text_.begin() + long(place), '\n'));
    counted_ = place;
    return line_;
  }

  /// Lines "n: … ;", some over several lines of the text.
  void statements(std::size_t begin, std::size_t end) {
    long last = 0;
    std::size_t at = std::min(text_.find('\n', begin), end);
    for (std::size_t statement = std::string_view::npos; at < end;) {
      const std::size_t start = at + 1, stop = std::min(text_.find('\n', start), end);
      at = stop;
      const std::size_t colon = text_.find(':', start);
      if (statement == std::string_view::npos) {
        if (colon >= stop) continue;
        const std::vector<Token> number = tokens_of(text_, tp_lexical, start, colon);
        if (number.size() == 2 && number[0].kind == Token::Kind::number) last = long(number[0].value);
        std::size_t body = colon + 1;
        while (body < stop && text_[body] == ' ') ++body;
        const std::string_view rest = text_.substr(body, stop - body);
        if (rest.starts_with("!") || rest.starts_with("//") || rest.starts_with("--")) continue;
        statement = body;
      }
      if (text_.substr(statement, stop - statement).find(';') == std::string_view::npos && stop < end) continue;
      instruction(statement, stop);
      statement = std::string_view::npos;
    }
    place_of_remark(end, last);
  }

  void place_of_remark(std::size_t end, long last) {
    RemarkPlace place;
    place.at = end;
    std::string number = std::to_string(last + 1);
    if (number.size() < 4) number.insert(0, 4 - number.size(), ' ');
    place.before = number + ":  !";
    place.after = " ;";
    place.longest = 32;
    const std::size_t count = text_.find("LINE_COUNT");
    if (count < end) {
      const std::vector<Token> tokens = tokens_of(text_, tp_lexical, count, std::min(text_.find('\n', count), end));
      if (tokens.size() > 2 && tokens[2].kind == Token::Kind::number)
        place.line_count = TextNumber{tokens[2].begin, tokens[2].end, tokens[2].value};
    }
    found_.remark = place;
  }

  struct Mention {
    std::string name;  ///< P[3]; empty: chosen by a register
    bool is_register;  ///< PR
  };

  static std::optional<Mention> mention(TokenCursor& cursor) {
    const std::string word = upper(cursor.text());
    const bool place = word == "P" || word == "@P", position_register = word == "PR";
    if ((!place && !position_register) || !cursor.ahead(1).is('[', cursor.source())) return std::nullopt;
    const Token number = cursor.ahead(2);
    cursor.skip();
    cursor.skip();
    if (number.kind != Token::Kind::number) return Mention{"", position_register};
    return Mention{"P[" + std::to_string(long(std::min(number.value, 1e9))) + "]", position_register};
  }

  void instruction(std::size_t begin, std::size_t end) {
    const std::vector<Token> tokens = tokens_of(text_, tp_lexical, begin, end);
    TokenCursor cursor(text_, tokens);
    const int line = line_of(begin);
    const std::string first = cursor.is_word() ? upper(cursor.text()) : "";
    const std::string_view next = cursor.text(cursor.ahead(1));
    const bool moves = first.size() == 1 && std::string_view("JLCAS").find(first) != std::string_view::npos &&
                       (next == "P" || next == "@P" || next == "PR" || next == "@PR");
    const std::vector<std::string> options = options_of(cursor);
    const auto has = [&](const char* option) {
      return std::find(options.begin(), options.end(), option) != options.end();
    };
    std::size_t wanted = first == "C" ? 2 : 1;
    for (; !cursor.done() && wanted > 0; cursor.skip()) {
      if (!cursor.is_word()) continue;
      const auto at = mention(cursor);
      if (!at) continue;
      if (moves) --wanted;
      Use use{line, moves ? first : "operand", moves ? Role::pose : Role::operand};
      use.name = at->name;
      use.straight = first == "L";
      if (at->is_register || at->name.empty()) {
        if (!moves) continue;
        use.role = Role::unclear;
        use.name.clear();
        use.why =
            at->is_register ? "position register: its value is not in the program" : "a register chooses its point";
      } else if (moves && has("INC")) {
        use.role = Role::step;
        use.instruction += " INC";
      } else if (moves && (has("OFFSET") || has("TOOL_OFFSET") || has("VOFFSET"))) {
        use.role = Role::offset;
        use.why = use.name;
      }
      found_.uses.push_back(use);
    }
    if (moves && wanted > 0) found_.uses.push_back({line, first, Role::unclear, "", {}, "its point is not understood"});
  }

  static std::vector<std::string> options_of(TokenCursor cursor) {
    std::vector<std::string> words;
    for (; !cursor.done(); cursor.skip())
      if (cursor.is_word()) words.push_back(upper(cursor.text()));
    return words;
  }

  /// P[n:"name"]{ … };
  void points(std::size_t begin) {
    for (std::size_t at = begin; (at = text_.find("P[", at)) < text_.size();) {
      const std::size_t open = text_.find('{', at), close = text_.find('}', at);
      if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
        found_.points.push_back({line_of(at), "", Form::unclear, {}, "has no values between { and }"});
        break;
      }
      point(at, open, close);
      at = close;
    }
  }

  void point(std::size_t at, std::size_t open, std::size_t close) {
    FoundPoint point{line_of(at)};
    const std::vector<Token> head = tokens_of(text_, {"", "\"", "_", false}, at, open);
    TokenCursor cursor(text_, head);
    if (const auto name = mention(cursor)) point.name = name->name;
    cursor.skip();
    if (cursor.take(':') && !cursor.done()) {
      std::string_view label = cursor.text();
      if (label.size() >= 2 && label.front() == '"') label = label.substr(1, label.size() - 2);
      point.label = label;
    }
    values(point, open + 1, close);
    found_.points.push_back(point);
  }

  /// NAME = number of the arm's group, GPn.NAME of the others, which are other mechanisms.
  void values(FoundPoint& point, std::size_t begin, std::size_t end) {
    const std::vector<Token> tokens = tokens_of(text_, {"", "'", "_", false}, begin, end);
    TokenCursor cursor(text_, tokens);
    std::string group;
    for (; !cursor.done(); cursor.skip()) {
      if (!cursor.is_word()) continue;
      const std::string word = upper(cursor.text());
      if (word.starts_with("GP") && word.size() > 2 && is_digit(word[2])) group = word == "GP1" ? "" : word + ".";
      if (group.empty() && cursor.ahead(1).is(':', text_) && (word == "UF" || word == "UT" || word == "CONFIG")) {
        head_of_pose(point, word, cursor.ahead(2));
        continue;
      }
      if (!cursor.ahead(1).is('=', text_)) continue;
      cursor.skip();
      cursor.skip();
      if (group.empty() && word == "X") point.form = Form::pose;
      const Expression value = read_expression(cursor, {});
      if (value.is(Expression::Kind::constant)) {
        point.axes.emplace_back(group + word, TextNumber{value.begin, value.end, value.value});
      } else {
        point.form = Form::unclear;
        point.why = word + " has no value";
        return;
      }
    }
  }

  /// UF : 1, UT : 2, CONFIG : 'N U T, 0, 0, 0'
  void head_of_pose(FoundPoint& point, const std::string& word, const Token& value) {
    const std::string text(text_.substr(value.begin, value.end - value.begin));
    if (word == "UF") point.frames.base.name = text;
    if (word == "UT") point.frames.tool.name = text;
    if (word == "CONFIG" && value.kind == Token::Kind::text && text.size() >= 2)
      configuration(point, tokens_of(text_, {"", "", "_", false}, value.begin + 1, value.end - 1));
  }

  void configuration(FoundPoint& point, const std::vector<Token>& parts) {
    static constexpr std::array<std::pair<const char*, const char*>, 3> letters = {
        {{"flip", "NF"}, {"elbow", "UD"}, {"side", "TB"}}};
    static constexpr std::array<const char*, 3> turns = {"turn1", "turn4", "turn6"};
    std::size_t turn = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Token& token = parts[i];
      const std::string part = upper(text_.substr(token.begin, token.end - token.begin));
      for (const auto& [name, pair] : letters)
        if (part.size() == 1 && std::string_view(pair).find(part) != std::string_view::npos)
          point.axes.emplace_back(name, TextNumber{token.begin, token.end, part[0] == pair[0] ? 0.0 : 1.0});
      if (token.kind != Token::Kind::number || turn >= turns.size()) continue;
      const bool minus = i > 0 && parts[i - 1].is('-', text_);
      point.axes.emplace_back(turns[turn++], TextNumber{minus ? parts[i - 1].begin : token.begin, token.end,
                                                        minus ? -token.value : token.value});
    }
  }

  const Source& source_;
  std::string_view text_;
  Reading found_;
  std::size_t counted_ = 0;
  int line_ = 1;
};

}  // namespace

Reading read_tp(const Source& source) { return Tp(source).run(); }

}  // namespace posewright::programs
