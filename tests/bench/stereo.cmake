find_package(OpenCV REQUIRED COMPONENTS core imgproc calib3d imgcodecs)
target_sources(gfp_bench PRIVATE ${CMAKE_CURRENT_LIST_DIR}/stereo_bench.cpp ${CMAKE_CURRENT_LIST_DIR}/peers_opencv_stereo.cpp)
target_link_libraries(gfp_bench PRIVATE gfp::cloud gfp::frame opencv_calib3d opencv_imgcodecs)
