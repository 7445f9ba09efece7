# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Configures the project as for 3D Slicer, twice (the second time its settings are in the cache), and looks at what would be built.
# Usage: cmake -DSOURCE=... -DWORK=... -DSLICER=... -P configureForSlicer.cmake
file(REMOVE_RECURSE ${WORK})
foreach(time first second)
  execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK} -DSlicer_DIR=${SLICER} RESULT_VARIABLE result
    OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "configured for the ${time} time:\n${output}")
  endif()
endforeach()

file(READ ${WORK}/build.ninja rules)
foreach(wanted "build lib/Slicer-5.0/qt-loadable-modules/libqSlicerHandEyeCalibrationModule.so" "build lib/libHandEyeCore.a" "-std=c\\+\\+17" "-fPIC")
  if(NOT rules MATCHES "${wanted}")
    message(FATAL_ERROR "build.ninja has no ${wanted}")
  endif()
endforeach()
# The plugin alone is shared, and only it is installed.
foreach(unwanted "build lib/lib[A-Za-z]*.so" "-std=[a-z+]*1[14]" "OSMesa" "NavigationDesktop" "libHandEyeSlicerBase")
  if(rules MATCHES "${unwanted}")
    message(FATAL_ERROR "build.ninja has ${CMAKE_MATCH_0}")
  endif()
endforeach()
