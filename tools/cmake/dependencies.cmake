# All dependencies, wrapped into targets whose headers count as system headers, since our warnings are for our code. Measured versions:
# docs/decisions/ and the distribution's packages.

if(HANDHOLD_SOURCES)
  include(${CMAKE_CURRENT_LIST_DIR}/dependency_sources.cmake)
else()
  include(${CMAKE_CURRENT_LIST_DIR}/runtime_dependencies.cmake)
endif()

# Bullet's solver: only for the lab, which compares it with ours.
add_library(handhold_bullet_dynamics INTERFACE)
add_library(handhold::bullet_dynamics ALIAS handhold_bullet_dynamics)
target_link_libraries(handhold_bullet_dynamics INTERFACE BulletDynamics-float64 handhold::bullet)

if(HANDHOLD_BUILD_GAME)
  find_package(CLI11 REQUIRED)
  pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
  pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)  # FindOpenGL would require libOpenGL, which is unused
  pkg_check_modules(sdl2 REQUIRED IMPORTED_TARGET sdl2)
  pkg_check_modules(imgui REQUIRED imgui)
  pkg_check_modules(openxr IMPORTED_TARGET openxr)  # the loader; without it `play --xr` reports that
  if(NOT openxr_FOUND)
    message(STATUS "OpenXR not found: building the game without headset support")
  endif()
  # Matches over a network; without it `serve` and `--join` report that. OpenSSL, for tokens, comes with libwebsockets' package.
  if(HANDHOLD_NETWORK)
    pkg_check_modules(websockets IMPORTED_TARGET libwebsockets libcrypto)
    # From version 1 on its names differ.
    pkg_check_modules(quic IMPORTED_TARGET libngtcp2>=0.12 libngtcp2<1 libngtcp2_crypto_gnutls gnutls)
    pkg_check_modules(zstd IMPORTED_TARGET libzstd)  # smaller join states
  else()
    unset(zstd_FOUND CACHE)
    unset(websockets_FOUND CACHE)
    unset(quic_FOUND CACHE)
  endif()
  if(NOT websockets_FOUND)
    message(STATUS "libwebsockets not found: building the game without matches over WebSocket")
  endif()
  if(NOT quic_FOUND)
    message(STATUS "ngtcp2 with GnuTLS not found: building the game without matches over QUIC")
  endif()
  if(NOT zstd_FOUND)
    message(STATUS "zstd not found: states of matches are sent as they are")
  endif()
  find_path(STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb REQUIRED)
  add_library(handhold_stb INTERFACE)
  add_library(handhold::stb ALIAS handhold_stb)
  target_include_directories(handhold_stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})
endif()
if(HANDHOLD_BUILD_TESTS AND NOT HANDHOLD_SOURCES)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
endif()
if(HANDHOLD_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()
