// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "support/chart_table.h"

/// One function a chart: what it measures stands at the head of its source. `quick` measures a few points of it.
namespace meniscus::bench {

ChartTable oscillation_chart(bool quick);
ChartTable sessile_chart(bool quick);
ChartTable curvature_chart(bool quick);
ChartTable volume_correction_chart(bool quick);
ChartTable merge_remesh_chart(bool quick);
ChartTable size_chart(bool quick);
ChartTable thread_chart(bool quick);

}  // namespace meniscus::bench
