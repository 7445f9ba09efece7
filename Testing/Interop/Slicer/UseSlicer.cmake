# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# As Slicer's file of this name: libraries are shared unless they say otherwise, and a macro makes the module.
set(BUILD_SHARED_LIBS ON)

macro(slicerMacroBuildLoadableModule)
  cmake_parse_arguments(module "NO_INSTALL;NO_TITLE;WITH_GENERIC_TESTS" "NAME;TITLE;EXPORT_DIRECTIVE"
    "SRCS;MOC_SRCS;UI_SRCS;INCLUDE_DIRECTORIES;TARGET_LIBRARIES;RESOURCES" ${ARGN})
  if(module_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "slicerMacroBuildLoadableModule does not know ${module_UNPARSED_ARGUMENTS}")
  endif()
  qt5_wrap_cpp(module_moc ${module_MOC_SRCS})
  qt5_wrap_ui(module_ui ${module_UI_SRCS})
  qt5_add_resources(module_resources ${module_RESOURCES})
  add_library(qSlicer${module_NAME}Module ${module_SRCS} ${module_moc} ${module_ui} ${module_resources})
  set_target_properties(qSlicer${module_NAME}Module PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${Slicer_QTLOADABLEMODULES_LIB_DIR})
  target_link_libraries(qSlicer${module_NAME}Module PUBLIC ${module_TARGET_LIBRARIES} ${Slicer_GUI_LIBRARY})
  install(TARGETS qSlicer${module_NAME}Module LIBRARY DESTINATION ${Slicer_INSTALL_QTLOADABLEMODULES_LIB_DIR})
endmacro()
