# Dependencies of the runtime library, for this build and for users of the installed library: handholdConfig.cmake includes this file too.
# They are imported targets, so their headers count as system headers and exports refer to them by name.

# Eigen: no version in find_package (3.4's and 5's version files refuse each other's expressions).
find_package(Eigen3 REQUIRED NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "Eigen 3.4 or newer is needed, found ${Eigen3_VERSION}")
endif()
add_library(handhold::eigen INTERFACE IMPORTED)
get_target_property(eigen_includes Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
target_include_directories(handhold::eigen SYSTEM INTERFACE ${eigen_includes})
# Vectorised sums depend on the instruction set, in their order and so in their last bits; hosts need the same layout of Eigen's types.
target_compile_definitions(handhold::eigen INTERFACE EIGEN_DONT_VECTORIZE)

# Bullet in double precision. The package's CMake config is broken on Debian 12, and the float and double sets share their headers, so
# pkg-config is used.
find_package(PkgConfig REQUIRED)
pkg_check_modules(bullet IMPORTED_TARGET bullet-float64)
add_library(handhold::bullet INTERFACE IMPORTED)
if(bullet_FOUND)
  target_include_directories(handhold::bullet SYSTEM INTERFACE ${bullet_INCLUDE_DIRS})
  target_link_libraries(handhold::bullet INTERFACE BulletCollision-float64 LinearMath-float64)
else()  # elsewhere, such as vcpkg's bullet3[double-precision]
  find_package(Bullet CONFIG REQUIRED)
  if(NOT "${BULLET_DEFINITIONS}" MATCHES "BT_USE_DOUBLE_PRECISION")
    message(FATAL_ERROR "Bullet in double precision is needed; this one is built without BT_USE_DOUBLE_PRECISION")
  endif()
  target_include_directories(handhold::bullet SYSTEM INTERFACE ${BULLET_INCLUDE_DIRS} ${BULLET_ROOT_DIR}/${BULLET_INCLUDE_DIR})
  target_link_libraries(handhold::bullet INTERFACE BulletCollision LinearMath)
endif()
target_compile_definitions(handhold::bullet INTERFACE BT_USE_DOUBLE_PRECISION)
find_package(box2d REQUIRED)
if(box2d_VERSION AND NOT box2d_VERSION VERSION_LESS 3)
  message(FATAL_ERROR "Box2D 2.4 is needed, found ${box2d_VERSION}, whose interface is another one")
endif()
find_package(meshoptimizer REQUIRED)
if(NOT DEFINED HANDHOLD_THREADS OR HANDHOLD_THREADS)
  find_package(TBB REQUIRED)
endif()
find_package(nlohmann_json REQUIRED)

# Draco decodes KHR_draco_mesh_compression. It is optional: without it the glTF reader refuses files that require the
# extension. The installed package defines HANDHOLD_HAS_DRACO as the library was built; -DHANDHOLD_HAS_DRACO=OFF builds without.
if(NOT DEFINED HANDHOLD_HAS_DRACO)
  find_package(draco QUIET)
  set(HANDHOLD_HAS_DRACO ${draco_FOUND})
elseif(HANDHOLD_HAS_DRACO)
  find_package(draco REQUIRED)
endif()
