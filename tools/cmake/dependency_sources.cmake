# The runtime's dependencies from their sources, for targets whose distribution has no packages of them (tools/cross). HANDHOLD_SOURCES has
# the folders bullet, box2d and meshoptimizer, and `include` with the headers of all but Bullet. Without threads and Draco.
#
# -ffp-contract=off, as for our own sources: a fused multiply-add in Bullet changes the state.
add_library(handhold_headers INTERFACE)
target_include_directories(handhold_headers SYSTEM INTERFACE ${HANDHOLD_SOURCES}/include)
add_library(handhold::eigen ALIAS handhold_headers)
target_compile_definitions(handhold_headers INTERFACE EIGEN_DONT_VECTORIZE)  # see runtime_dependencies.cmake
add_library(nlohmann_json::nlohmann_json ALIAS handhold_headers)

function(handhold_library_from_sources name alias include_dir)
  add_library(${name} STATIC ${ARGN})
  add_library(${alias} ALIAS ${name})
  target_include_directories(${name} SYSTEM PUBLIC ${include_dir})
  target_compile_options(${name} PRIVATE -w -ffp-contract=off)
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF POSITION_INDEPENDENT_CODE ${handhold_position_independent})
endfunction()

set(bullet ${HANDHOLD_SOURCES}/bullet/src)
file(GLOB bullet_sources ${bullet}/LinearMath/*.cpp ${bullet}/BulletCollision/CollisionShapes/*.cpp
  ${bullet}/BulletCollision/NarrowPhaseCollision/*.cpp ${bullet}/BulletCollision/BroadphaseCollision/bt[DQ]*.cpp)
# They need the dispatchers or threads, which we do not use.
list(FILTER bullet_sources EXCLUDE REGEX "btMiniSDF|btSdfCollisionShape|btHeightfield|btQuickprof")
handhold_library_from_sources(handhold_bullet handhold::bullet ${bullet} ${bullet_sources})
target_compile_definitions(handhold_bullet PUBLIC BT_USE_DOUBLE_PRECISION BT_NO_PROFILE)

set(box2d ${HANDHOLD_SOURCES}/box2d)
file(GLOB box2d_sources ${box2d}/src/collision/b2_distance.cpp ${box2d}/src/collision/b2_*_shape.cpp
  ${box2d}/src/common/b2_math.cpp ${box2d}/src/common/b2_settings.cpp ${box2d}/src/common/b2_block_allocator.cpp
  ${box2d}/src/collision/b2_collision.cpp)
handhold_library_from_sources(handhold_box2d box2d::box2d ${box2d}/include ${box2d_sources})

file(GLOB meshoptimizer_sources ${HANDHOLD_SOURCES}/meshoptimizer/src/*.cpp)
handhold_library_from_sources(handhold_meshoptimizer meshoptimizer::meshoptimizer
  ${HANDHOLD_SOURCES}/meshoptimizer/src ${meshoptimizer_sources})

if(HANDHOLD_BUILD_TESTS)
  add_subdirectory(/usr/src/googletest googletest EXCLUDE_FROM_ALL)  # Debian's package googletest
  set_target_properties(gtest gtest_main PROPERTIES UNITY_BUILD OFF)
endif()
