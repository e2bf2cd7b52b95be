target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/fitting_bench.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::evaluation gfp::modelling gfp::registration TBB::tbb)
