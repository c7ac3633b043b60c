// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace meniscus {

/// Bytes as base64 (RFC 4648, with padding, without line ends).
std::string base64(std::string_view bytes);

}  // namespace meniscus
