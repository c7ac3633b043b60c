// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/drop.h"

#include <nlohmann/json.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// The state of a run as named values. A class takes part by one function, the same in both directions:
///
///     template <class Self, class Archive>
///     static void visit(Self& self, Archive& archive) { archive("time", self.time_); ... }
///
/// Values are numbers, enums, flags, strings, drops, classes with such a function, lists of numbers (std::vector,
/// std::array, Eigen's of fixed size) and std::vectors of drops and such classes. Doubles keep their bits.
namespace meniscus {

namespace checkpoint {

using State = nlohmann::json;

template <class T, class = void>
struct is_numbers : std::false_type {};
template <class T>
struct is_numbers<T, std::void_t<decltype(*std::declval<T&>().data()), decltype(std::declval<T&>().size())>>
    : std::bool_constant<std::is_arithmetic_v<std::decay_t<decltype(*std::declval<T&>().data())>> &&
                         !std::is_same_v<T, std::string>> {};
template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};

State bytes_of(const void* data, std::size_t size);
State drop_state(const Drop& drop);
Drop restored_drop(const State& state, const std::string& where);
[[noreturn]] void fail(const std::string& where, const std::string& what);
/// The member `name`; throws FileError if there is none.
const State& member(const State& state, const std::string& where, const char* name);
/// The bytes, a whole number of elements of `element` bytes; throws FileError.
const std::vector<std::uint8_t>& bytes_in(const State& state, const std::string& where, std::size_t element);
void copy_bytes(const std::vector<std::uint8_t>& bytes, void* to);
std::int64_t integer_in(const State& state, const std::string& where, std::int64_t least, std::int64_t most);

}  // namespace checkpoint

/// Takes values down. Throws std::logic_error for a drop with a property map of a type that it does not know.
class CheckpointWriter {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    state_[name] = to_state(value);
  }
  const checkpoint::State& state() const { return state_; }

 private:
  template <class T>
  static checkpoint::State to_state(const T& value) {
    if constexpr (std::is_enum_v<T>)
      return static_cast<std::int64_t>(value);
    else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
      return value;
    else if constexpr (checkpoint::is_numbers<T>::value)
      return checkpoint::bytes_of(value.data(), static_cast<std::size_t>(value.size()) * sizeof(*value.data()));
    else if constexpr (checkpoint::is_vector<T>::value) {
      checkpoint::State list = checkpoint::State::array();
      for (const auto& item : value) list.push_back(to_state(item));
      return list;
    } else if constexpr (std::is_same_v<T, Drop>)
      return checkpoint::drop_state(value);
    else {
      CheckpointWriter members;
      T::visit(value, members);
      return members.state_;
    }
  }

  checkpoint::State state_ = checkpoint::State::object();
};

/// Gives values back. Throws FileError, naming the value, for one that is missing, of another type or out of
/// range, or for a drop that is none; `where` comes first in the message.
class CheckpointReader {
 public:
  CheckpointReader(const checkpoint::State& state, std::string where) : state_(state), where_(std::move(where)) {}

  template <class T>
  void operator()(const char* name, T& value) {
    read(checkpoint::member(state_, where_, name), where_ + "/" + name, value);
  }

 private:
  template <class T>
  static void read(const checkpoint::State& state, const std::string& where, T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
      const auto* stored =
          state.template get_ptr<const std::conditional_t<std::is_same_v<T, bool>, bool, std::string>*>();
      if (!stored) checkpoint::fail(where, "is of another type");
      value = *stored;
    } else if constexpr (std::is_floating_point_v<T>) {
      if (!state.is_number_float()) checkpoint::fail(where, "is no number");
      value = state.template get<T>();
      if (value != value) checkpoint::fail(where, "is no number");
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(checkpoint::integer_in(state, where, 0, 255));
    } else if constexpr (std::is_integral_v<T>) {
      using Limits = std::numeric_limits<T>;
      constexpr std::int64_t most =
          sizeof(T) < 8 ? static_cast<std::int64_t>(Limits::max()) : std::numeric_limits<std::int64_t>::max();
      value = static_cast<T>(checkpoint::integer_in(state, where, static_cast<std::int64_t>(Limits::min()), most));
    } else if constexpr (checkpoint::is_numbers<T>::value) {
      read_numbers(checkpoint::bytes_in(state, where, sizeof(*value.data())), where, value);
    } else if constexpr (checkpoint::is_vector<T>::value) {
      if (!state.is_array()) checkpoint::fail(where, "is no list");
      value.clear();
      for (std::size_t i = 0; i < state.size(); ++i) read_item(state[i], where + "/" + std::to_string(i), value);
    } else {
      if (!state.is_object()) checkpoint::fail(where, "is no set of values");
      CheckpointReader members(state, where);
      T::visit(value, members);
    }
  }
  template <class T>
  static void read_item(const checkpoint::State& state, const std::string& where, std::vector<T>& list) {
    if constexpr (std::is_same_v<T, Drop>)
      list.push_back(checkpoint::restored_drop(state, where));
    else
      read(state, where, list.emplace_back());
  }
  template <class T>
  static void read_numbers(const std::vector<std::uint8_t>& bytes, const std::string& where, T& value) {
    const std::size_t count = bytes.size() / sizeof(*value.data());
    if constexpr (checkpoint::is_vector<T>::value) value.resize(count);
    if (static_cast<std::size_t>(value.size()) != count) checkpoint::fail(where, "has another number of numbers");
    checkpoint::copy_bytes(bytes, value.data());
  }

  const checkpoint::State& state_;
  std::string where_;
};

}  // namespace meniscus
