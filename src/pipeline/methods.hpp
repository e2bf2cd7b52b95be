#pragma once

#include <string_view>
#include <vector>

#include "gfp/pipeline/fit_view.hpp"

namespace gfp {

/// One way to fit an object (P31). To add one, write its function and put it into the table in methods.cpp.
struct Method {
  std::string_view name;
  std::vector<Candidate> (*fit)(const ObjectView&, const PrimitiveLibrary&, const PipelineOptions&, StageTimings&);
};

/// By name, or kNotFound naming the known ones.
Result<Method> find_method(std::string_view name);

std::vector<Candidate> fit_gfp_robust(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_gfp_paper(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_gfp_grid26(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_sphere_snake_only(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_simple_primitive_only(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_nearest_instance(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_multi_superquadric_only(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);
std::vector<Candidate> fit_superquadric_only(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings);

}  // namespace gfp
