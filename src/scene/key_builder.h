// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene_table.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

/// How the table is written down: a row is a call with the key's name, unit, range, meaning and field.
namespace meniscus::scene_detail {

inline const Range any_number;
inline const Range positive{0, std::numeric_limits<double>::infinity(), true, false};
inline const Range not_negative{0, std::numeric_limits<double>::infinity(), false, false};

inline double to_radians(double degrees) { return degrees * (pi / 180); }

// The degrees that to_radians takes to exactly these radians, the shortest such number first.
inline double to_degrees(double radians) {
  const double degrees = radians * (180 / pi);
  for (const int digits : {12, 14, 15, 16, 17}) {
    const double rounded = std::stod(fmt::format("{:.{}g}", degrees, digits));
    if (to_radians(rounded) == radians) return rounded;
  }
  double below = degrees, above = degrees;
  for (int i = 0; i < 4; ++i) {
    below = std::nextafter(below, -std::numeric_limits<double>::infinity());
    above = std::nextafter(above, std::numeric_limits<double>::infinity());
    if (to_radians(below) == radians) return below;
    if (to_radians(above) == radians) return above;
  }
  return degrees;
}

inline Eigen::Vector3d to_vector3(const Json& value, double (*convert)(double)) {
  return {convert(value[0].get<double>()), convert(value[1].get<double>()), convert(value[2].get<double>())};
}

inline double as_is(double x) { return x; }

// A list of the keys that objects of type T are written with, in the order of the file.
template <class T>
class Keys {
 public:
  using Predicate = bool (*)(const T&);

  template <class F>
  Keys& number(const char* name, const char* unit, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::number, help, unit, range);
    bind(
        key, [field](const T& t) { return Json(field(t)); },
        [field](T& t, const Json& value) { field(t) = value.get<double>(); });
    return *this;
  }
  template <class F>
  Keys& optional_number(const char* name, const char* unit, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::number, help, unit, range);
    bind(
        key, [field](const T& t) { return field(t) ? Json(*field(t)) : Json(); },
        [field](T& t, const Json& value) { field(t) = value.get<double>(); });
    return *this;
  }
  template <class F>
  Keys& integer(const char* name, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::integer, help, "", range);
    bind(
        key, [field](const T& t) { return Json(field(t)); },
        [field](T& t, const Json& value) { field(t) = static_cast<int>(value.get<double>()); });
    return *this;
  }
  template <class F>
  Keys& boolean(const char* name, const char* help, F field) {
    Key& key = add(name, KeyKind::boolean, help);
    bind(
        key, [field](const T& t) { return Json(field(t)); },
        [field](T& t, const Json& value) { field(t) = value.get<bool>(); });
    return *this;
  }
  template <class F>
  Keys& text(const char* name, const char* help, F field) {
    Key& key = add(name, KeyKind::text, help);
    bind(
        key, [field](const T& t) { return field(t).empty() ? Json() : Json(field(t)); },
        [field](T& t, const Json& value) { field(t) = value.get<std::string>(); });
    return *this;
  }
  template <class F>
  Keys& file(const char* name, const char* help, F field) {
    Key& key = add(name, KeyKind::file, help);
    bind(
        key, [field](const T& t) { return field(t).empty() ? Json() : Json(field(t).generic_string()); },
        [field](T& t, const Json& value) { field(t) = std::filesystem::path(value.get<std::string>()); });
    return *this;
  }
  // Degrees in the file, radians in the field.
  template <class F>
  Keys& angle(const char* name, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::number, help, "degrees", range);
    bind(
        key, [field](const T& t) { return Json(to_degrees(field(t))); },
        [field](T& t, const Json& value) { field(t) = to_radians(value.get<double>()); });
    return *this;
  }
  template <class F>
  Keys& optional_angle(const char* name, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::number, help, "degrees", range);
    bind(
        key, [field](const T& t) { return field(t) ? Json(to_degrees(*field(t))) : Json(); },
        [field](T& t, const Json& value) { field(t) = to_radians(value.get<double>()); });
    return *this;
  }
  template <class F>
  Keys& vector(const char* name, const char* unit, const Range& range, const char* help, F field) {
    Key& key = add(name, KeyKind::vector, help, unit, range);
    bind(
        key,
        [field](const T& t) {
          return Json{field(t).x(), field(t).y(), field(t).z()};
        },
        [field](T& t, const Json& value) { field(t) = to_vector3(value, as_is); });
    return *this;
  }
  template <class F>
  Keys& angles(const char* name, const char* help, F field) {
    Key& key = add(name, KeyKind::vector, help, "degrees");
    bind(
        key,
        [field](const T& t) {
          return Json{to_degrees(field(t).x()), to_degrees(field(t).y()), to_degrees(field(t).z())};
        },
        [field](T& t, const Json& value) { field(t) = to_vector3(value, to_radians); });
    return *this;
  }
  // Words and what they stand for; the words in `planned` are not available yet.
  template <class E, class F>
  Keys& choice(const char* name, const char* help, const std::vector<std::pair<const char*, E>>& words,
               const std::vector<const char*>& planned, F field) {
    Key& key = add(name, KeyKind::choice, help);
    for (const auto& word : words) key.choices.push_back({word.first, true});
    for (const char* word : planned) key.choices.push_back({word, false});
    bind(
        key,
        [field, words](const T& t) {
          for (const auto& word : words) {
            if (word.second == field(t)) return Json(word.first);
          }
          return Json();
        },
        [field, words](T& t, const Json& value) {
          for (const auto& word : words) {
            if (value == word.first) field(t) = word.second;
          }
        });
    return *this;
  }
  // An object whose keys are fields of the same T.
  Keys& section(const char* name, const char* help, Keys keys) {
    add(name, KeyKind::section, help).keys = std::move(keys.keys_);
    return *this;
  }
  template <class F, class Item>
  Keys& list(const char* name, const char* help, F field, Items items, Keys<Item> keys) {
    items.keys = keys.take();
    items.defaults = std::make_shared<const Item>();
    items.append = [field](void* owner) -> void* { return &field(*static_cast<T*>(owner)).emplace_back(); };
    items.all = [field](const void* owner) {
      std::vector<const void*> all;
      for (const Item& item : field(*static_cast<const T*>(owner))) all.push_back(&item);
      return all;
    };
    add(name, KeyKind::list, help).items = std::make_shared<const Items>(std::move(items));
    return *this;
  }
  Keys& unavailable(const char* name, const char* help) {
    add(name, KeyKind::unavailable, help);
    return *this;
  }
  Keys& ignored(const char* name, const char* help) {
    add(name, KeyKind::ignored, help);
    return *this;
  }

  // What follows speaks of the key added last.

  // A choice has one more word, which stands for a state of its own.
  Keys& also(const char* word, Predicate is_so, void (*make_so)(T&)) {
    Key& key = keys_.back();
    key.choices.push_back({word, true});
    key.get = [get = key.get, word, is_so](const void* owner) {
      return is_so(*static_cast<const T*>(owner)) ? Json(word) : get(owner);
    };
    key.set = [set = key.set, word, make_so](void* owner, const Json& value) {
      if (value == word) return make_so(*static_cast<T*>(owner));
      set(owner, value);
    };
    return *this;
  }
  // Sets a flag, too, if the file has the key.
  template <class F>
  Keys& flag(F field) {
    keys_.back().set = [set = keys_.back().set, field](void* owner, const Json& value) {
      set(owner, value);
      field(*static_cast<T*>(owner)) = true;
    };
    return *this;
  }
  Keys& required() {
    keys_.back().is_required = true;
    return *this;
  }
  Keys& nonzero() {
    keys_.back().is_nonzero = true;
    return *this;
  }
  Keys& note(const char* text_of_default) {
    keys_.back().default_note = text_of_default;
    return *this;
  }
  Keys& of(std::vector<std::string> shapes) {
    keys_.back().shapes = std::move(shapes);
    return *this;
  }
  Keys& write_if(Predicate is_written) {
    keys_.back().get = [get = keys_.back().get, is_written](const void* owner) {
      return is_written(*static_cast<const T*>(owner)) ? get(owner) : Json();
    };
    return *this;
  }

  std::vector<Key> take() { return std::move(keys_); }

 private:
  Key& add(const char* name, KeyKind kind, const char* help, const char* unit = "", const Range& range = any_number) {
    Key& key = keys_.emplace_back();
    key.name = name;
    key.kind = kind;
    key.help = help;
    key.unit = unit;
    key.range = range;
    return key;
  }
  template <class Get, class Set>
  static void bind(Key& key, Get get, Set set) {
    key.get = [get](const void* owner) { return get(*static_cast<const T*>(owner)); };
    key.set = [set](void* owner, const Json& value) { set(*static_cast<T*>(owner), value); };
  }

  std::vector<Key> keys_;
};

}  // namespace meniscus::scene_detail
