# An overlay port of this source tree: vcpkg install handhold --overlay-ports=packaging/vcpkg
# Box2D 2.4 is needed: pin it in your manifest, "overrides": [ { "name": "box2d", "version": "2.4.1" } ].
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DHANDHOLD_BUILD_GAME=OFF -DHANDHOLD_BUILD_TESTS=OFF -DHANDHOLD_BUILD_BENCH=OFF -DHANDHOLD_HAS_DRACO=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME handhold CONFIG_PATH lib/cmake/handhold)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
