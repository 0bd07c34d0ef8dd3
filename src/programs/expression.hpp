#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// How readers of programs look at text: places stay those of the file, so that values are replaced where they stand.

namespace posewright::programs {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
inline bool is_word(char c) { return is_letter(c) || is_digit(c); }
std::string upper(std::string_view text);

struct Token {
  enum class Kind { word, number, text, symbol, line_end, end };
  Kind kind = Kind::end;
  std::size_t begin = 0, end = 0;
  int line = 0;
  double value = 0.0;  ///< of a number, without its sign

  bool is(char c, std::string_view source) const { return kind == Kind::symbol && source[begin] == c; }
};

/// Tokens of a language.
struct LexRules {
  std::string_view comment;        ///< begins one that ends with the line
  std::string_view quotes = "\"";  ///< marks that texts stand between, each within its line
  std::string_view letters = "_";  ///< that words may begin with beside A to Z
  bool lines = false;              ///< the end of a line is a token
};

/// The tokens of a text from `begin` to `end`, the last of Kind::end.
std::vector<Token> tokens_of(std::string_view text, const LexRules& rules, std::size_t begin = 0,
                             std::size_t end = std::string_view::npos, int first_line = 1);

/// A reading place among tokens.
class TokenCursor {
 public:
  TokenCursor(std::string_view source, const std::vector<Token>& tokens, std::size_t place = 0)
      : at(place), source_(source), tokens_(&tokens) {}

  const Token& now() const { return (*tokens_)[at]; }
  const Token& ahead(std::size_t count) const;
  const Token& before() const { return (*tokens_)[at == 0 ? 0 : at - 1]; }
  bool done() const { return now().kind == Token::Kind::end; }
  void skip() { at += done() ? 0 : 1; }
  bool sees(char c) const { return now().is(c, source_); }
  bool take(char c) {
    const bool found = sees(c);
    if (found) skip();
    return found;
  }
  bool is_word() const { return now().kind == Token::Kind::word; }
  std::string_view text(const Token& token) const { return source_.substr(token.begin, token.end - token.begin); }
  std::string_view text() const { return text(now()); }
  std::string_view source() const { return source_; }
  /// To the next token that is one of `symbols`, a line's end, or the end; not past it.
  void skip_to(std::string_view symbols, bool line_ends);

  std::size_t at;

 private:
  std::string_view source_;
  const std::vector<Token>* tokens_;
};

/// A name with the indices and parts behind it: j1, XP1[3], p1.trans.z.
struct TakenName {
  std::string name;
  int line = 0;
  long index = -1;  ///< the last one that begins with a number
  bool component = false;
};
/// @param open, close  around an index; `close` begins with what ends it, other symbols end it where that lacks
/// @param in_line      an index ends with its line
TakenName take_name(TokenCursor& cursor, char open, std::string_view close, bool in_line);

/// An expression of a program, as far as points need it.
struct Expression {
  enum class Kind {
    constant,  ///< a number, or what follows from numbers
    name,      ///< of data, maybe with an index
    list,      ///< items between brackets
    call,      ///< of a function; items are its arguments
    other      ///< what only a controller computes; items are its parts
  };
  Kind kind = Kind::other;
  std::size_t begin = 0, end = 0;
  int line = 0;
  double value = 0.0;      ///< of a constant
  std::string word;        ///< name, function, or what stands before a list's bracket (`p` of p[…])
  std::string label;       ///< of a list's item: A1 of {A1 10.0}
  bool component = false;  ///< a name with a part of it: p1.trans.z, q[2] of one list
  std::vector<Expression> items;

  bool is(Kind k) const { return kind == k; }
};

/// Form of expressions in a language.
struct ExpressionRules {
  char list = '[', index = '[';  ///< brackets that open a list, an index
  bool labels = false;           ///< items of lists have names: {A1 10.0}
  bool line_ends = false;        ///< a line's end ends an expression outside of brackets
};

/// The expression at a cursor, which is left behind it.
Expression read_expression(TokenCursor& cursor, const ExpressionRules& rules);

}  // namespace posewright::programs
