target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/pipeline.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::app TBB::tbb)
