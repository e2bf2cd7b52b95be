target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/grasps_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/../grasp/qhull_oracle.cpp
               ${CMAKE_CURRENT_LIST_DIR}/../grasp/shapes.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::grasp Qhull::qhull_r)
