target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/service_bench.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::publish gfp::wire)
