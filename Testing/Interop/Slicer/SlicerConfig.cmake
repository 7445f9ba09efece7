# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the package of 3D Slicer 5.0 does to a project that finds it, as far as configuring shows: it refuses other C++ settings than its
# own, sets them, and has its libraries as imported targets. Not a Slicer: nothing can be built with it.
foreach(setting CXX_STANDARD=14 CXX_STANDARD_REQUIRED=TRUE CXX_EXTENSIONS=FALSE)
  string(REPLACE "=" ";" parts ${setting})
  list(GET parts 0 name)
  list(GET parts 1 value)
  if(DEFINED CMAKE_${name} AND NOT "${CMAKE_${name}}" STREQUAL "${value}")
    message(FATAL_ERROR "CMAKE_${name} was set to ${CMAKE_${name}} before Slicer was found, whose own is ${value}")
  endif()
  set(CMAKE_${name} ${value} CACHE STRING "Slicer's" FORCE)
endforeach()

set(Slicer_USE_FILE ${CMAKE_CURRENT_LIST_DIR}/UseSlicer.cmake)
set(Slicer_QTLOADABLEMODULES_LIB_DIR lib/Slicer-5.0/qt-loadable-modules)
set(Slicer_INSTALL_QTLOADABLEMODULES_LIB_DIR ./lib/Slicer-5.0/qt-loadable-modules)
set(Slicer_INSTALL_QTLOADABLEMODULES_SHARE_DIR ./share/Slicer-5.0/qt-loadable-modules)
set(Slicer_GUI_LIBRARY qSlicerBaseQTGUI)
find_package(VTK REQUIRED)
find_package(Qt5 REQUIRED COMPONENTS Widgets)
foreach(library MRMLCore MRMLLogic SlicerBaseLogic qSlicerBaseQTGUI)
  if(NOT TARGET ${library})
    add_library(${library} SHARED IMPORTED)
    set_target_properties(${library} PROPERTIES IMPORTED_LOCATION ${CMAKE_CURRENT_LIST_DIR}/lib${library}.so)
  endif()
endforeach()
