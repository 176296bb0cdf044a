# cmake --install: the library for find_package(handhold) and pkg-config. Components: runtime (the shared library), dev (everything to
# build against it), game.
#
#   handhold::handhold   the C interface and its C++ wrapper; shared or static as BUILD_SHARED_LIBS said
#   handhold::runtime    static, with the columns and stages too
include(CMakePackageConfigHelpers)

set(handhold_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/handhold)
set_target_properties(handhold_runtime PROPERTIES EXPORT_NAME runtime)
set_target_properties(handhold_host PROPERTIES EXPORT_NAME handhold)
install(TARGETS handhold_runtime EXPORT handholdTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(TARGETS handhold_host EXPORT handholdTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT dev)
install(EXPORT handholdTargets NAMESPACE handhold:: DESTINATION ${handhold_package_dir} COMPONENT dev)
# The public headers and the headers that they include; see install_headers.cmake.
install(CODE "set(SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
set(PUBLIC_DIR \"${PROJECT_SOURCE_DIR}/systems/host/include\")
set(DESTINATION \"${CMAKE_INSTALL_INCLUDEDIR}\")" COMPONENT dev)
install(SCRIPT ${PROJECT_SOURCE_DIR}/tools/cmake/install_headers.cmake COMPONENT dev)
configure_package_config_file(tools/cmake/handholdConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake
  INSTALL_DESTINATION ${handhold_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake
  tools/cmake/runtime_dependencies.cmake DESTINATION ${handhold_package_dir} COMPONENT dev)

file(RELATIVE_PATH handhold_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
set(handhold_pc_static "-lhandhold_runtime -lbox2d -lmeshoptimizer -lBulletCollision-float64 -lLinearMath-float64 -ltbb -lstdc++ -lm")
if(HANDHOLD_HAS_DRACO)
  string(REPLACE "-lmeshoptimizer" "-lmeshoptimizer -ldraco" handhold_pc_static "${handhold_pc_static}")
endif()
set(handhold_pc_libs ${handhold_pc_static})
if(BUILD_SHARED_LIBS)
  set(handhold_pc_libs -lhandhold)
endif()
configure_file(tools/cmake/handhold.pc.in ${CMAKE_CURRENT_BINARY_DIR}/handhold.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/handhold.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
