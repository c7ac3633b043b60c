// SPDX-License-Identifier: GPL-3.0-or-later
#include "attribute_maps.h"

namespace meniscus {
namespace {

template <class T>
bool add_if_of_type(const Mesh& mesh, const std::string& name, std::vector<Mesh::Property_map<VertexIndex, T>>& maps) {
  const auto found = mesh.property_map<VertexIndex, T>(name);
  if (found.second) maps.push_back(found.first);
  return found.second;
}

template <class Tuple, class Visit>
void for_each_map(Tuple& tuple, Visit visit) {
  std::apply(
      [&](auto&... lists) {
        const auto visit_list = [&](auto& list) {
          for (auto& map : list) visit(map);
        };
        (visit_list(lists), ...);
      },
      tuple);
}

bool is_internal(const std::string& name) {
  return name == "v:point" || name == "v:connectivity" || name == "v:removed";
}

/// A map's value at a point of a face.
template <class T>
T value_at(const Mesh::Property_map<VertexIndex, T>& map, const AttributeSource& source) {
  const auto& [v, w] = source;
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<T>(double{map[v[0]]} + w[1] * (double{map[v[1]]} - double{map[v[0]]}) +
                          w[2] * (double{map[v[2]]} - double{map[v[0]]}));
  else if constexpr (std::is_same_v<T, Vector>)
    return map[v[0]] + w[1] * (map[v[1]] - map[v[0]]) + w[2] * (map[v[2]] - map[v[0]]);
  else
    return map[v[w[0] >= w[1] ? (w[0] >= w[2] ? 0 : 2) : (w[1] >= w[2] ? 1 : 2)]];
}

enum class Gather { replace, blend };

template <class T>
bool gather_if_of_type(const Mesh& from, Mesh& to, const std::string& name, const std::vector<AttributeSource>& sources,
                       std::size_t first_row, Gather how) {
  const auto found = from.property_map<VertexIndex, T>(name);
  if (!found.second) return false;
  auto map = to.add_property_map<VertexIndex, T>(name).first;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    T& value = map[VertexIndex(static_cast<Mesh::size_type>(first_row + i))];
    const T there = value_at(found.first, sources[i]);
    if (how == Gather::replace) {
      value = there;
      continue;
    }
    if constexpr (std::is_floating_point_v<T>) value = static_cast<T>(0.5 * (double{value} + double{there}));
    if constexpr (std::is_same_v<T, Vector>) value = 0.5 * (value + there);
  }
  return true;
}

template <class... T>
void gather_one(const Mesh& from, Mesh& to, const std::string& name, const std::vector<AttributeSource>& sources,
                std::size_t first_row, Gather how) {
  (gather_if_of_type<T>(from, to, name, sources, first_row, how) || ...);
}

void gather_all(const Mesh& from, Mesh& to, const std::vector<AttributeSource>& sources, std::size_t first_row,
                Gather how) {
  for (const auto& name : from.properties<VertexIndex>())
    if (!is_internal(name))
      gather_one<double, float, Vector, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                 std::uint32_t, std::int64_t, std::uint64_t, Contact>(from, to, name, sources, first_row, how);
}

}  // namespace

void gather_attributes(const Mesh& from, Mesh& to, const std::vector<AttributeSource>& sources, std::size_t first_row) {
  gather_all(from, to, sources, first_row, Gather::replace);
}

void blend_attributes(const Mesh& from, Mesh& to, const std::vector<AttributeSource>& sources, std::size_t first_row) {
  gather_all(from, to, sources, first_row, Gather::blend);
}

void AttributeMaps::clear() {
  const auto clear_list = [](auto&... lists) { (lists.clear(), ...); };
  std::apply(clear_list, continuous_);
  std::apply(clear_list, discrete_);
  bound_ = false;
}

void AttributeMaps::bind(Mesh& mesh) {
  clear();
  for (const auto& name : mesh.properties<VertexIndex>()) {
    if (is_internal(name)) continue;
    const auto try_all = [&](auto&... lists) { return (add_if_of_type(mesh, name, lists) || ...); };
    if (!std::apply(try_all, continuous_)) std::apply(try_all, discrete_);
  }
  bound_ = true;
}

void AttributeMaps::interpolate(VertexIndex into, VertexIndex a, VertexIndex b, double t) {
  for_each_map(continuous_, [&](auto& map) {
    using T = std::decay_t<decltype(map[a])>;
    if constexpr (std::is_same_v<T, float>)
      map[into] = static_cast<float>(double{map[a]} + t * (double{map[b]} - double{map[a]}));
    else
      map[into] = map[a] + t * (map[b] - map[a]);
  });
  const auto nearer = t > 0.5 ? b : a;
  for_each_map(discrete_, [&](auto& map) { map[into] = map[nearer]; });
}

void AttributeMaps::shift(VertexIndex into, VertexIndex a, double s, VertexIndex b, double t) {
  for_each_map(continuous_, [&](auto& map) {
    using T = std::decay_t<decltype(map[a])>;
    if constexpr (std::is_same_v<T, float>)
      map[into] = static_cast<float>(double{map[into]} + s * (double{map[a]} - double{map[into]}) +
                                     t * (double{map[b]} - double{map[into]}));
    else
      map[into] = map[into] + s * (map[a] - map[into]) + t * (map[b] - map[into]);
  });
}

void AttributeMaps::copy(VertexIndex into, VertexIndex from) {
  const auto copy_one = [&](auto& map) { map[into] = map[from]; };
  for_each_map(continuous_, copy_one);
  for_each_map(discrete_, copy_one);
}

}  // namespace meniscus
