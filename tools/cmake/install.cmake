# cmake --install: the runtime library for find_package(handhold), which gives the target handhold::runtime. The game is a
# program of its own and is run where it is built.
include(CMakePackageConfigHelpers)

set(handhold_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/handhold)
set_target_properties(handhold_runtime PROPERTIES EXPORT_NAME runtime)
install(TARGETS handhold_runtime EXPORT handholdTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT handhold_runtime)
install(EXPORT handholdTargets NAMESPACE handhold:: DESTINATION ${handhold_package_dir} COMPONENT handhold_runtime)
# The public headers and what they reach; see install_headers.cmake.
install(CODE "set(SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
set(PUBLIC_DIR \"${PROJECT_SOURCE_DIR}/systems/host/include\")
set(DESTINATION \"${CMAKE_INSTALL_INCLUDEDIR}\")" COMPONENT handhold_runtime)
install(SCRIPT ${PROJECT_SOURCE_DIR}/tools/cmake/install_headers.cmake COMPONENT handhold_runtime)
configure_package_config_file(tools/cmake/handholdConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake
  INSTALL_DESTINATION ${handhold_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake
  tools/cmake/runtime_dependencies.cmake DESTINATION ${handhold_package_dir} COMPONENT handhold_runtime)
