#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright {

/// A struct that names the fields that go to other processes: `static auto fields(auto& own) { return std::tie(…); }`.
template <class T>
concept HasFields = requires(T& value) {
  T::fields(value);
};

/// Values one after the other as the bytes of this kind of machine, for results that go to a log or to another process
/// of the same program.
class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(std::string_view text) {
    put(std::uint64_t(text.size()));
    bytes_.append(text);
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(std::uint64_t(values.size()));
    for (const T& value : values) put(value);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::unique_ptr<T>& value) {
    put(*value);
  }
  template <class A, class B>
  void put(const std::pair<A, B>& pair) {
    put(pair.first), put(pair.second);
  }
  template <HasFields T>
  void put(const T& value) {
    std::apply([&](const auto&... fields) { (put(fields), ...); }, T::fields(value));
  }
  void put(const Eigen::VectorXd& values) {
    put(std::uint64_t(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), std::size_t(values.size()) * sizeof(double));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads the bytes of ByteWriter, in the same order. Throws CannotDo where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void get(T& value) { std::memcpy(&value, taken(sizeof value).data(), sizeof value); }
  void get(std::string& text) { text = std::string(taken(size())); }
  template <class T>
  void get(std::vector<T>& values) {
    // Nothing is taken for granted of a size: a value has a byte at least.
    const std::size_t count = size();
    if (count > rest_.size()) cut_short();
    values.resize(count);
    for (T& value : values) get(value);
  }
  template <class T>
  void get(std::optional<T>& value) {
    if (get<bool>()) get(value.emplace());
    else value.reset();
  }
  template <class T>
  void get(std::unique_ptr<T>& value) {
    get(*(value = std::make_unique<T>()));
  }
  template <class A, class B>
  void get(std::pair<A, B>& pair) {
    get(pair.first), get(pair.second);
  }
  template <HasFields T>
  void get(T& value) {
    std::apply([&](auto&... fields) { (get(fields), ...); }, T::fields(value));
  }
  void get(Eigen::VectorXd& values) {
    const std::size_t count = size();
    if (count > rest_.size() / sizeof(double)) cut_short();
    const std::string_view bytes = taken(count * sizeof(double));
    values.resize(Eigen::Index(count));
    std::memcpy(values.data(), bytes.data(), bytes.size());
  }
  template <class T>
  T get() {
    T value{};
    get(value);
    return value;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  [[noreturn]] static void cut_short() { throw CannotDo("the result of a task is cut short"); }
  std::size_t size() { return std::size_t(get<std::uint64_t>()); }
  std::string_view taken(std::size_t count) {
    if (count > rest_.size()) cut_short();
    const std::string_view part = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return part;
  }

  std::string_view rest_;
};

/// The bytes of one value.
template <class T>
std::string bytes_of(const T& value) {
  ByteWriter writer;
  writer.put(value);
  return writer.take();
}

/// The value of such bytes.
template <class T>
T value_in(std::string_view bytes) {
  return ByteReader(bytes).get<T>();
}

}  // namespace posewright
