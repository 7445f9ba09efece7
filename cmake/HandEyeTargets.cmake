# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# What every target of ours has in common: warnings, sanitizer, ccache.

find_program(HANDEYE_CCACHE ccache)
if(HANDEYE_CCACHE)
  # Precompiled headers go into the cache only when their macros and time stamps are not compared.
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    ${HANDEYE_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()

if(HANDEYE_SANITIZER)
  add_compile_options(-fsanitize=${HANDEYE_SANITIZER} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${HANDEYE_SANITIZER})
endif()

# handeye_configure_target(<target>): warnings as the presets ask for them.
function(handeye_configure_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    $<$<BOOL:${HANDEYE_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# handeye_add_library(<target> ALIAS <name> [STATIC|SHARED] [INTERNAL] SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...)
# A layer: its own folder is its public include directory, so that a layer cannot include what it does not link. INTERNAL: a part of
# our programs and plugins, which is not installed by itself.
function(handeye_add_library target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC;SHARED;INTERNAL" "ALIAS" "SOURCES;HEADERS;PUBLIC;PRIVATE")
  set(type)
  if(arg_STATIC OR HANDEYE_SLICER_BUILD)
    # Slicer builds shared libraries unless it is told otherwise; all that is ours goes into the one file of the plugin.
    set(type STATIC)
  elseif(arg_SHARED)
    set(type SHARED)
  endif()
  add_library(${target} ${type} ${arg_SOURCES} ${arg_HEADERS})
  add_library(HandEye::${arg_ALIAS} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${arg_ALIAS} VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/HandEye>)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  handeye_configure_target(${target})
  if(arg_INTERNAL OR HANDEYE_SLICER_BUILD)
    return()
  endif()
  install(TARGETS ${target} EXPORT HandEyeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(FILES ${arg_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/HandEye)
endfunction()

# handeye_use_qt(<target> [TRANSLATED]): moc, uic and rcc for a target; the others do not pay for looking. TRANSLATED: texts go through
# tr(), and a plain string does not become a QString by itself.
function(handeye_use_qt target)
  set_target_properties(${target} PROPERTIES AUTOMOC ON AUTOUIC ON AUTORCC ON
    AUTOUIC_SEARCH_PATHS "${PROJECT_SOURCE_DIR}/Resources/UI;${PROJECT_SOURCE_DIR}/Module/Resources/UI")
  target_compile_definitions(${target} PRIVATE QT_NO_FOREACH QT_DEPRECATED_WARNINGS
    $<$<STREQUAL:"${ARGV1}","TRANSLATED">:QT_NO_CAST_FROM_ASCII>)
endfunction()
