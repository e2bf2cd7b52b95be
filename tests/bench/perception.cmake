find_package(OpenCV REQUIRED COMPONENTS core imgproc rgbd)
find_package(nanoflann REQUIRED)

# Peers sit behind plain headers, each library in one file.
target_sources(gfp_bench PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/bench_scenes.cpp ${CMAKE_CURRENT_LIST_DIR}/cloud_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/radius_bench.cpp
  ${CMAKE_CURRENT_LIST_DIR}/segmentation_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/peers_opencv.cpp ${CMAKE_CURRENT_LIST_DIR}/peers_pcl.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../segmentation/labelled_scene.cpp)
target_compile_definitions(gfp_bench PRIVATE GFP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_include_directories(gfp_bench SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(gfp_bench PRIVATE gfp::cloud gfp::segmentation gfp::simulation lzf opencv_core opencv_imgproc opencv_rgbd nanoflann::nanoflann)
gfp_use_pcl(gfp_bench SOURCES ${CMAKE_CURRENT_LIST_DIR}/peers_pcl.cpp PARTS common kdtree octree search sample_consensus filters features segmentation)
