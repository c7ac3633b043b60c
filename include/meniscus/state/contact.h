// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace meniscus {

/// Where a vertex is in respect to the solids.
enum class Contact : std::uint8_t {
  free = 0,    ///< on the water-air surface
  wetted = 1,  ///< on a solid, like all its neighbours
  line = 2,    ///< on a solid, with a neighbour that is not: the contact line of the paper's Figure 3
};

inline bool is_colliding(Contact contact) { return contact != Contact::free; }

/// What a vertex of the contact line did last, at the level `pressure`; `advancing` off the line.
enum class LineStatus : std::uint8_t { advancing = 0, stuck = 1, receding = 2 };

}  // namespace meniscus
