#pragma once

#include <memory>

#include "gfp/evaluation/cases.hpp"

namespace gfp {

/// Where a table case looks from.
struct TableViewpoint {
  double elevation_deg = 35;
  double yaw_deg = 0;  ///< Of the object about its up axis; the camera stays at -y of the table.
};

/// The object alone on a table before the virtual camera, behind a box where options.occlusion asks for one.
EvaluationCase make_table_case(const std::shared_ptr<const TruthShape>& shape, const TableViewpoint& viewpoint, const CaseOptions& options, std::uint64_t seed);

/// The specs of all views of one object; `index` tells objects of a set apart, for their yaws.
void add_table_cases(const std::string& source, const std::shared_ptr<const TruthShape>& shape, const CaseOptions& options,
                     std::uint64_t index, std::vector<CaseSpec>& specs);

}  // namespace gfp
