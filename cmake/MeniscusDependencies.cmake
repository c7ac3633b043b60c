# Everything comes from Debian 12; scripts/packages.txt lists it.
find_package(CGAL 5.5 REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(TinyGLTF REQUIRED)

# Debian's SuiteSparse 5 ships no CMake config.
find_path(MENISCUS_CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(MENISCUS_CHOLMOD_LIBRARY cholmod REQUIRED)
add_library(meniscus_cholmod INTERFACE)
target_include_directories(meniscus_cholmod SYSTEM INTERFACE $<BUILD_INTERFACE:${MENISCUS_CHOLMOD_INCLUDE}>)
target_link_libraries(meniscus_cholmod INTERFACE ${MENISCUS_CHOLMOD_LIBRARY})

# CGAL's headers are not ours to warn about.
foreach(target CGAL::CGAL fmt::fmt TBB::tbb)
  get_target_property(real ${target} ALIASED_TARGET)
  if(real)
    set(target ${real})
  endif()
  get_target_property(dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
  if(dirs)
    set_property(TARGET ${target} APPEND PROPERTY INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${dirs}")
  endif()
endforeach()
