# find_package(handhold CONFIG): handhold::handhold, the shared library of this archive (@TARGET@).
get_filename_component(handhold_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET handhold::handhold)
  add_library(handhold::handhold SHARED IMPORTED)
  set_target_properties(handhold::handhold PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${handhold_prefix}/include")
  if(WIN32)
    set_target_properties(handhold::handhold PROPERTIES IMPORTED_LOCATION "${handhold_prefix}/bin/handhold.dll"
      IMPORTED_IMPLIB "${handhold_prefix}/lib/handhold.lib")
  else()
    set_target_properties(handhold::handhold PROPERTIES IMPORTED_LOCATION "${handhold_prefix}/lib/libhandhold.so.@VERSION@"
      IMPORTED_SONAME "libhandhold.so.@MINOR_VERSION@")
  endif()
endif()
