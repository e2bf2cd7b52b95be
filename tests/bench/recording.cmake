target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/recording_bench.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::app gfp::recording gfp::wire)
