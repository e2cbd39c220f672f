// Result tables of the suites, one measure per row.
#pragma once

#include "common/report.h"

namespace relief::bench {

Table make_paper1_table(const Value& result);
Table make_paper2_table(const Value& result);
Table make_paper3_table(const Value& result);
Table make_cycles_table(const Value& result);
Table make_quality_table(const Value& result);
Table make_edits_table(const Value& result);
Table make_triangles_table(const Value& result);
Table make_peers_table(const Value& result);

} // namespace relief::bench
