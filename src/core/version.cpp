// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/version.h"

namespace meniscus {

std::string version() { return MENISCUS_VERSION; }

}  // namespace meniscus
