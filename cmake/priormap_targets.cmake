# priormap_library(NAME SOURCES ... [PUBLIC ...] [PRIVATE ...])   libs/NAME -> priormap::NAME
# priormap_test(NAME SOURCES ... [LINK ...])                     one GoogleTest program of a library's tests
# priormap_tool(NAME LINK ...)                                   tools/NAME/main.cpp -> NAME
include_guard()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

option(PRIORMAP_WERROR "Warnings are errors" OFF)
set(PRIORMAP_SANITIZE "" CACHE STRING "Sanitizers for everything, such as address,undefined")

# Results must not depend on how the compiler contracts a*b+c: same bytes for the same input.
add_library(priormap_flags INTERFACE)
target_compile_options(priormap_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -ffp-contract=off)
# g++ 12 sees overlapping copies in any inlined std::string operator+ (GCC bug 105651).
target_compile_options(priormap_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(PRIORMAP_WERROR)
  target_compile_options(priormap_flags INTERFACE -Werror)
endif()
if(PRIORMAP_SANITIZE)
  add_compile_options(-fsanitize=${PRIORMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PRIORMAP_SANITIZE})
endif()
option(PRIORMAP_LIBFUZZER "Fuzz targets by libFuzzer (clang) instead of a plain driver that replays their corpora" OFF)
if(PRIORMAP_LIBFUZZER)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
install(TARGETS priormap_flags EXPORT priormapTargets)
add_library(priormap::flags ALIAS priormap_flags)

# A program loads only the shared libraries it calls: PCL's I/O alone brings 60.
add_link_options(LINKER:--as-needed)

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)

function(priormap_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;PUBLIC;PRIVATE")
  set(target priormap_${name})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/include/*.hpp")
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES})
    set(scope PUBLIC)
    target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
    target_link_libraries(${target} PRIVATE priormap_flags ${arg_PRIVATE})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(priormap::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS "${CMAKE_CURRENT_SOURCE_DIR}/include" FILES ${headers})
  target_include_directories(${target} ${scope}
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_link_libraries(${target} ${scope} Eigen3::Eigen ${arg_PUBLIC})
  install(TARGETS ${target} EXPORT priormapTargets FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
endfunction()

function(priormap_test name)
  if(NOT BUILD_TESTING)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "SOURCES;LINK")
  find_package(GTest REQUIRED)
  include(GoogleTest)
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE priormap_flags ${arg_LINK} GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    PRIORMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" PRIORMAP_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/tests/data")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS ${name})
endfunction()

function(priormap_tool name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK")
  add_executable(${name} main.cpp)
  target_link_libraries(${name} PRIVATE priormap_flags priormap::cli ${arg_LINK})
  install(TARGETS ${name} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endfunction()

function(priormap_install)
  include(CMakePackageConfigHelpers)
  install(EXPORT priormapTargets NAMESPACE priormap:: DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/priormap")
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/priormapConfig.cmake.in" "${PROJECT_BINARY_DIR}/priormapConfig.cmake"
    INSTALL_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/priormap")
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/priormapConfigVersion.cmake" COMPATIBILITY SameMajorVersion)
  install(FILES "${PROJECT_BINARY_DIR}/priormapConfig.cmake" "${PROJECT_BINARY_DIR}/priormapConfigVersion.cmake"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/priormap")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/schemas/" DESTINATION "${CMAKE_INSTALL_DATADIR}/priormap/schemas")
  # Laid out as in the source tree, so that links hold in both places.
  install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE NOTICE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
  install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation FILES_MATCHING PATTERN "*.md")
  install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation USE_SOURCE_PERMISSIONS PATTERN quickstart.sh EXCLUDE)
endfunction()
