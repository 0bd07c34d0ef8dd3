#pragma once

#include <string>
#include <vector>

#include "tokens.hpp"

namespace posewright::programs {

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
