# cmake --install: the runtime library for find_package(handhold), which gives the target handhold::runtime. The game is a
# program of its own and is run where it is built.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(handhold_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/handhold)
set_target_properties(handhold_runtime PROPERTIES EXPORT_NAME runtime)
install(TARGETS handhold_runtime EXPORT handholdTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT handhold_runtime)
install(EXPORT handholdTargets NAMESPACE handhold:: DESTINATION ${handhold_package_dir} COMPONENT handhold_runtime)
# All headers except private ones: those that show types of Bullet or nlohmann-json, and the parts of the glTF reader.
install(DIRECTORY engine components systems DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/handhold COMPONENT handhold_runtime
  FILES_MATCHING PATTERN "*.hpp"
  PATTERN "engine/collision/bullet_*.hpp" EXCLUDE
  PATTERN "engine/collision/pair_contact.hpp" EXCLUDE
  PATTERN "engine/collision/mesh_contact.hpp" EXCLUDE
  PATTERN "engine/io/gltf_accessors.hpp" EXCLUDE
  PATTERN "engine/io/gltf_buffer_writer.hpp" EXCLUDE
  PATTERN "engine/io/gltf_buffers.hpp" EXCLUDE
  PATTERN "engine/io/gltf_draco.hpp" EXCLUDE
  PATTERN "engine/io/gltf_meshopt.hpp" EXCLUDE
  PATTERN "engine/io/gltf_model.hpp" EXCLUDE
  PATTERN "engine/io/gltf_primitive.hpp" EXCLUDE
  PATTERN "engine/io/gltf_scene.hpp" EXCLUDE
  PATTERN "engine/io/json.hpp" EXCLUDE)
configure_package_config_file(tools/cmake/handholdConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake
  INSTALL_DESTINATION ${handhold_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/handholdConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/handholdConfigVersion.cmake
  tools/cmake/runtime_dependencies.cmake DESTINATION ${handhold_package_dir} COMPONENT handhold_runtime)
