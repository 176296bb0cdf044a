# Everything the project links, wrapped into targets whose headers count as system headers: our warnings are
# for our code. Versions measured with: docs/decisions.md and the distribution's packages.

# Eigen: no version in find_package (3.4's and 5's version files refuse each other's expressions).
find_package(Eigen3 REQUIRED NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "Eigen 3.4 or newer is needed, found ${Eigen3_VERSION}")
endif()
add_library(handhold_eigen INTERFACE)
add_library(handhold::eigen ALIAS handhold_eigen)
get_target_property(eigen_includes Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
target_include_directories(handhold_eigen SYSTEM INTERFACE ${eigen_includes})

# Bullet in double precision. The package's CMake config is broken on Debian 12 and the float and double sets
# share their headers: pkg-config names the right one.
find_package(PkgConfig REQUIRED)
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)
add_library(handhold_bullet INTERFACE)
add_library(handhold::bullet ALIAS handhold_bullet)
target_include_directories(handhold_bullet SYSTEM INTERFACE ${bullet_INCLUDE_DIRS})
target_compile_definitions(handhold_bullet INTERFACE BT_USE_DOUBLE_PRECISION)
target_link_libraries(handhold_bullet INTERFACE BulletCollision-float64 LinearMath-float64)
# Its solver too: only for the tool that compares ours with it.
add_library(handhold_bullet_dynamics INTERFACE)
add_library(handhold::bullet_dynamics ALIAS handhold_bullet_dynamics)
target_link_libraries(handhold_bullet_dynamics INTERFACE BulletDynamics-float64 handhold_bullet)

find_package(box2d REQUIRED)

find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TinyGLTF REQUIRED)
add_library(handhold_tinygltf INTERFACE)
add_library(handhold::tinygltf ALIAS handhold_tinygltf)
target_link_libraries(handhold_tinygltf INTERFACE TinyGLTF::TinyGLTF)
find_package(meshoptimizer REQUIRED)

if(HANDHOLD_BUILD_GAME)
  find_package(CLI11 REQUIRED)
  pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
  pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)  # FindOpenGL would ask for libOpenGL, which nothing here uses
  pkg_check_modules(sdl2 REQUIRED IMPORTED_TARGET sdl2)
  find_path(STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb REQUIRED)
  add_library(handhold_stb INTERFACE)
  add_library(handhold::stb ALIAS handhold_stb)
  target_include_directories(handhold_stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})
endif()
if(HANDHOLD_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
endif()
if(HANDHOLD_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()
