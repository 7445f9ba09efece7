# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the package of 3D Slicer does to a project that finds it, as far as configuring shows: it refuses other C++ settings than its
# own, sets them, says which Qt it has, and has its libraries as imported targets. Not a Slicer: nothing can be built with it.
# SLICER_VERSION says which it resembles: 5.0 (C++ 14, moc by macros), 5.10 (C++ 17, AUTOMOC) or 5.11 (Qt 6).
set(cxx_standard 17)
if(SLICER_VERSION VERSION_LESS 5.2)
  set(cxx_standard 14)
endif()
foreach(setting CXX_STANDARD=${cxx_standard} CXX_STANDARD_REQUIRED=TRUE CXX_EXTENSIONS=FALSE)
  string(REPLACE "=" ";" parts ${setting})
  list(GET parts 0 name)
  list(GET parts 1 value)
  if(DEFINED CMAKE_${name} AND NOT "${CMAKE_${name}}" STREQUAL "${value}")
    message(FATAL_ERROR "CMAKE_${name} was set to ${CMAKE_${name}} before Slicer was found, whose own is ${value}")
  endif()
  set(CMAKE_${name} ${value} CACHE STRING "Slicer's" FORCE)
endforeach()

set(Slicer_REQUIRED_QT_VERSION 5.15)
if(SLICER_VERSION VERSION_GREATER 5.10)
  set(Slicer_REQUIRED_QT_VERSION 6)
  return()
endif()
set(Slicer_USE_FILE ${CMAKE_CURRENT_LIST_DIR}/UseSlicer.cmake)
set(Slicer_QTLOADABLEMODULES_LIB_DIR lib/Slicer-${SLICER_VERSION}/qt-loadable-modules)
set(Slicer_INSTALL_QTLOADABLEMODULES_LIB_DIR ./lib/Slicer-${SLICER_VERSION}/qt-loadable-modules)
set(Slicer_INSTALL_QTLOADABLEMODULES_SHARE_DIR ./share/Slicer-${SLICER_VERSION}/qt-loadable-modules)
set(Slicer_GUI_LIBRARY qSlicerBaseQTGUI)
find_package(VTK REQUIRED)
find_package(Qt5 REQUIRED COMPONENTS Widgets)
foreach(library MRMLCore MRMLLogic SlicerBaseLogic qSlicerBaseQTGUI)
  if(NOT TARGET ${library})
    add_library(${library} SHARED IMPORTED)
    set_target_properties(${library} PROPERTIES IMPORTED_LOCATION ${CMAKE_CURRENT_LIST_DIR}/lib${library}.so)
  endif()
endforeach()
