# What every target of the project shares: language level, warnings, floating-point rules, sanitizers.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(GFP_CCACHE ccache)
if(GFP_CCACHE)  # without these sloppinesses ccache does not cache what includes a precompiled header
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${GFP_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${GFP_CCACHE})
endif()
find_program(GFP_MOLD mold)
if(GFP_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

add_library(gfp_options INTERFACE)
add_library(gfp::options ALIAS gfp_options)
set_target_properties(gfp_options PROPERTIES EXPORT_NAME options)
install(TARGETS gfp_options EXPORT gfpTargets)
# -ffp-contract=off and no -march: the same input gives the same bytes on every x86-64 machine (DESIGN, determinism). Nobody reads errno or
# floating-point exception flags: without them square roots are inlined and selections vectorised, to the same bits.
target_compile_options(gfp_options INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wshadow -Wpedantic -ffp-contract=off -fno-math-errno -fno-trapping-math $<$<BOOL:${GFP_WARNINGS_AS_ERRORS}>:-Werror>>)
target_include_directories(gfp_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(gfp_options INTERFACE cxx_std_20)
if(GFP_SANITIZE)
  add_compile_options(-fsanitize=${GFP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize=vptr)
  add_link_options(-fsanitize=${GFP_SANITIZE})
endif()

# Parsing Eigen and the standard library is most of what a compilation costs: done once for the libraries, once for the tests.
# Sources still include what they use; GFP_PRECOMPILE=OFF shows it.
add_library(gfp_precompiled STATIC ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
target_link_libraries(gfp_precompiled PRIVATE gfp::options Eigen3::Eigen)
target_precompile_headers(gfp_precompiled PRIVATE <Eigen/Dense> <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <span> <string> <string_view> <vector>)

# gfp_precompile(<target> <precompiled>): executables are compiled as libraries are, else the compiler refuses the precompiled header.
function(gfp_precompile target precompiled)
  if(GFP_PRECOMPILE)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIC)
    endif()
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
endfunction()

# gfp_library(<folder> SOURCES a.cpp... [PUBLIC targets...] [PRIVATE targets...])
# One static library a folder, gfp_<folder>, known to users as gfp::<folder>.
function(gfp_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(gfp_${folder} STATIC ${ARG_SOURCES})
  add_library(gfp::${folder} ALIAS gfp_${folder})
  set_target_properties(gfp_${folder} PROPERTIES EXPORT_NAME ${folder})
  target_include_directories(gfp_${folder} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(gfp_${folder} PUBLIC gfp::options ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  gfp_precompile(gfp_${folder} gfp_precompiled)
  install(TARGETS gfp_${folder} EXPORT gfpTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/gfp)
endfunction()

# gfp_test(<name> SOURCES a_test.cpp... [LINK targets...] [LABELS labels...]): one GoogleTest program, found by ctest.
function(gfp_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main GTest::gmock)
  gfp_precompile(${name} gfp_tests_precompiled)
  set(properties TIMEOUT 300)
  if(ARG_LABELS)
    list(APPEND properties LABELS "${ARG_LABELS}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES ${properties})
endfunction()

# gfp_use_pcl(<target> SOURCES a.cpp... PARTS common kdtree...): PCL's headers (unpacked by scripts/install-packages) for the named files
# only, and its runtime libraries.
function(gfp_use_pcl target)
  cmake_parse_arguments(ARG "" "" "SOURCES;PARTS" ${ARGN})
  set(pcl_dir $ENV{HOME}/.cache/gfp/pcl)
  if(DEFINED ENV{GFP_PCL_DIR})
    set(pcl_dir $ENV{GFP_PCL_DIR})
  endif()
  find_path(GFP_PCL_INCLUDE pcl/point_types.h PATHS ${pcl_dir}/usr/include/pcl-1.13 /usr/include/pcl-1.13 REQUIRED NO_CACHE)
  set_source_files_properties(${ARG_SOURCES} PROPERTIES COMPILE_OPTIONS "-isystem;${GFP_PCL_INCLUDE};-Wno-array-bounds")  # GCC 12 misreads its unrolled 3-vectors
  foreach(part IN LISTS ARG_PARTS)
    find_library(GFP_PCL_${part} NAMES libpcl_${part}.so libpcl_${part}.so.1.13 REQUIRED)
    target_link_libraries(${target} PRIVATE ${GFP_PCL_${part}})
  endforeach()
  find_library(GFP_FLANN NAMES flann_cpp REQUIRED)
  target_link_libraries(${target} PRIVATE ${GFP_FLANN} lz4)
endfunction()

function(gfp_install_package)
  include(CMakePackageConfigHelpers)
  set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gfp)
  install(DIRECTORY include/gfp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT gfpTargets NAMESPACE gfp:: DESTINATION ${package_dir})
  configure_package_config_file(cmake/gfpConfig.cmake.in ${PROJECT_BINARY_DIR}/gfpConfig.cmake INSTALL_DESTINATION ${package_dir})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/gfpConfigVersion.cmake COMPATIBILITY SameMajorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/gfpConfig.cmake ${PROJECT_BINARY_DIR}/gfpConfigVersion.cmake DESTINATION ${package_dir})
endfunction()
