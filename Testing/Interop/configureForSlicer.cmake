# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Configures the project as for 3D Slicer, twice (the second time its settings are in the cache), and looks at what would be built.
# Usage: cmake -DSOURCE=... -DWORK=... -DSLICER=... -P configureForSlicer.cmake
file(REMOVE_RECURSE ${WORK})

function(configure version result)
  execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/${version} -DSlicer_DIR=${SLICER} -DSLICER_VERSION=${version}
    RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${result} ${code} PARENT_SCOPE)
  set(output "${text}" PARENT_SCOPE)
endfunction()

foreach(version 5.0 5.10)
  foreach(time first second)
    configure(${version} result)
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "configured for the ${time} time as for Slicer ${version}:\n${output}")
    endif()
  endforeach()

  file(READ ${WORK}/${version}/build.ninja rules)
  foreach(wanted "build lib/Slicer-${version}/qt-loadable-modules/libqSlicerHandEyeCalibrationModule.so" "build lib/libHandEyeCore.a" "-std=c\\+\\+17" "-fPIC")
    if(NOT rules MATCHES "${wanted}")
      message(FATAL_ERROR "build.ninja for Slicer ${version} has no ${wanted}")
    endif()
  endforeach()
  # The plugin alone is shared, and only it is installed.
  foreach(unwanted "build lib/lib[A-Za-z]*.so" "-std=[a-z+]*1[14]" "OSMesa" "NavigationDesktop" "libHandEyeSlicerBase")
    if(rules MATCHES "${unwanted}")
      message(FATAL_ERROR "build.ninja for Slicer ${version} has ${CMAKE_MATCH_0}")
    endif()
  endforeach()
endforeach()

configure(5.11 result)
if(result EQUAL 0 OR NOT output MATCHES "needs one[ \n]+with[ \n]+Qt[ \n]+5.15")
  message(FATAL_ERROR "a Slicer with Qt 6 is not refused in words:\n${output}")
endif()
