# What every target of ours is compiled with.
add_library(meniscus_options INTERFACE)
target_compile_features(meniscus_options INTERFACE cxx_std_17)
target_compile_options(meniscus_options INTERFACE
  $<BUILD_INTERFACE:-fPIC -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual
  -ffp-contract=off>)  # the same bits whatever the optimiser would fuse
if(MENISCUS_WERROR)
  target_compile_options(meniscus_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(MENISCUS_MARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(meniscus_options INTERFACE -march=${MENISCUS_MARCH})
endif()

# Compiles a target of ours with the headers that nearly every source includes, compiled once. Sources still
# name what they use: tests/layout compiles each header alone.
function(meniscus_precompile target)
  if(NOT MENISCUS_PCH)
    return()
  endif()
  if(target STREQUAL meniscus_core)
    target_precompile_headers(meniscus_core PRIVATE <meniscus/core/types.h> <Eigen/Dense> <Eigen/Sparse> <fmt/format.h>
      <algorithm> <array> <cmath> <cstdint> <filesystem> <map> <memory> <numeric> <optional> <string> <utility> <vector>)
  else()
    target_precompile_headers(${target} REUSE_FROM meniscus_core)
  endif()
endfunction()

# meniscus_folder(NAME LINK ...): the library meniscus_NAME of src/NAME and include/meniscus/NAME.
function(meniscus_folder name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/${name}/*.cpp)
  if(NOT sources)  # nothing there yet
    add_library(meniscus_${name} INTERFACE)
    set_property(GLOBAL APPEND PROPERTY MENISCUS_FOLDERS meniscus_${name})
    return()
  endif()
  add_library(meniscus_${name} STATIC ${sources})
  target_include_directories(meniscus_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(meniscus_${name} PUBLIC meniscus_options ${ARG_LINK})
  meniscus_precompile(meniscus_${name})
  set_property(GLOBAL APPEND PROPERTY MENISCUS_FOLDERS meniscus_${name})
endfunction()

# meniscus::meniscus, the whole library.
function(meniscus_umbrella)
  get_property(folders GLOBAL PROPERTY MENISCUS_FOLDERS)
  add_library(meniscus INTERFACE)
  target_link_libraries(meniscus INTERFACE ${folders})
  add_library(meniscus::meniscus ALIAS meniscus)
endfunction()
