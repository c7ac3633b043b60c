// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace meniscus {

/// This library's version, as "0.1.0".
std::string version();

}  // namespace meniscus
