# find_package(meniscus) for others: cmake --install build/release --prefix DIR
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(folders GLOBAL PROPERTY MENISCUS_FOLDERS)
install(TARGETS meniscus meniscus_options meniscus_cholmod ${folders} EXPORT meniscusTargets)
install(DIRECTORY include/meniscus DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY data/scenes data/meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/meniscus)
if(MENISCUS_TOOLS)
  install(TARGETS meniscus_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/meniscus)
install(EXPORT meniscusTargets NAMESPACE meniscus:: DESTINATION ${config_dir})
configure_package_config_file(cmake/meniscusConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/meniscusConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/meniscusConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/meniscusConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/meniscusConfigVersion.cmake DESTINATION ${config_dir})
