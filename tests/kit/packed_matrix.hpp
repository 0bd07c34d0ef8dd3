#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace posewright {

/// Symmetric matrix (m × m) of a report's data: rows of the lower triangle, one behind the other.
inline Eigen::MatrixXd unpacked(const nlohmann::json& packed, Eigen::Index m) {
  Eigen::MatrixXd M(m, m);
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) M(i, j) = M(j, i) = packed.at(k++).get<double>();
  EXPECT_EQ(k, packed.size());
  return M;
}

/// Bytes of a base64 text, a letter's six bits after the other.
inline std::string bytes_of_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char letter : text.substr(0, text.find('='))) {
    held = held << 6 | std::uint32_t(letters.find(letter));
    if ((bits += 6) < 8) continue;
    bytes += char(held >> (bits -= 8) & 0xff);
  }
  return bytes;
}

/// JᵀJ of an entry of `poses` of a report's information, whose rows are whitened: J = W Lᵀ.
inline Eigen::MatrixXd information_of(const nlohmann::json& information, const nlohmann::json& pose, Eigen::Index m) {
  const Eigen::MatrixXd L = unpacked(information.at("factor"), m).triangularView<Eigen::Lower>();
  const std::string bytes = bytes_of_base64(pose.at("rows").get<std::string>());
  EXPECT_EQ(bytes.size() % std::size_t(4 * m), 0U);
  Eigen::MatrixXd W(Eigen::Index(bytes.size()) / (4 * m), m);
  for (Eigen::Index k = 0; k < W.size(); ++k) {
    std::uint32_t value = 0;
    for (int b = 3; b >= 0; --b) value = value << 8 | std::uint8_t(bytes[std::size_t(4 * k + b)]);
    W(k / m, k % m) = double(std::int32_t(value)) / std::ldexp(1.0, 30);
  }
  const Eigen::MatrixXd J = W * L.transpose();
  return J.transpose() * J;
}

/// AᵀA of an entry of `test` of a report's information.
inline Eigen::MatrixXd test_information(const nlohmann::json& test, Eigen::Index m) {
  const nlohmann::json& rows = test.at("rows");
  Eigen::MatrixXd A(Eigen::Index(rows.size()), m);
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < m; ++j) A(i, j) = rows.at(std::size_t(i)).at(std::size_t(j)).get<double>();
  return A.transpose() * A;
}

}  // namespace posewright
