# Runs at install time. Installs the public headers of PUBLIC_DIR as <prefix>/DESTINATION/handhold/, and the headers that they include as
# handhold/internal/, with includes rewritten: `#include "engine/..."` becomes `#include <handhold/internal/engine/...>`. A host's include
# path therefore has no folder of this repository. Variables: SOURCE_DIR, PUBLIC_DIR, DESTINATION.

cmake_policy(VERSION 3.25)

set(our_include "^[ \t]*#[ \t]*include[ \t]*\"((engine|components|systems)/[^\"]+)\"")

# Installs one header and adds the headers that it includes to the caller's `pending`.
function(install_header source target)
  file(READ ${source} text)
  file(STRINGS ${source} lines REGEX "${our_include}")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "${our_include}" ignored "${line}")
    list(APPEND pending ${CMAKE_MATCH_1})
  endforeach()
  string(REGEX REPLACE "(\n[ \t]*#[ \t]*include[ \t]*)\"((engine|components|systems)/[^\"]+)\"" "\\1<handhold/internal/\\2>" text "${text}")
  file(WRITE "$ENV{DESTDIR}${target}" "${text}")
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES ${target})
  set(CMAKE_INSTALL_MANIFEST_FILES ${CMAKE_INSTALL_MANIFEST_FILES} PARENT_SCOPE)
  set(pending ${pending} PARENT_SCOPE)
endfunction()

cmake_path(ABSOLUTE_PATH DESTINATION BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE include_dir)
set(pending)
set(installed)
file(GLOB public_headers ${PUBLIC_DIR}/handhold/*.h ${PUBLIC_DIR}/handhold/*.hpp)
foreach(header IN LISTS public_headers)
  cmake_path(GET header FILENAME name)
  install_header(${header} ${include_dir}/handhold/${name})
endforeach()
while(pending)
  list(POP_FRONT pending header)
  if(NOT header IN_LIST installed)
    list(APPEND installed ${header})
    install_header(${SOURCE_DIR}/${header} ${include_dir}/handhold/internal/${header})
  endif()
endwhile()
list(LENGTH installed internal_count)
message(STATUS "Installed the public headers and ${internal_count} that they include: ${include_dir}/handhold")
