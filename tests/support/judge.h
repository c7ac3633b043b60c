// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meniscus/state/judge.h"
