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
  foreach(mandatory NAME EXPORT_DIRECTIVE)
    if(NOT DEFINED module_${mandatory})
      message(FATAL_ERROR "slicerMacroBuildLoadableModule needs ${mandatory}")
    endif()
  endforeach()
  include_directories(${Slicer_Libs_INCLUDE_DIRS} ${Slicer_Base_INCLUDE_DIRS} ${module_INCLUDE_DIRECTORIES})
  if(SLICER_VERSION VERSION_LESS 5.10)
    qt5_wrap_cpp(module_moc ${module_MOC_SRCS})
    qt5_wrap_ui(module_ui ${module_UI_SRCS})
    qt5_add_resources(module_resources ${module_RESOURCES})
    add_library(qSlicer${module_NAME}Module ${module_SRCS} ${module_moc} ${module_ui} ${module_resources})
  else()
    # MOC_SRCS are not looked at any more, forms only for their folders.
    add_library(qSlicer${module_NAME}Module ${module_SRCS} ${module_RESOURCES})
    set(module_form_folders)
    foreach(form ${module_UI_SRCS})
      cmake_path(ABSOLUTE_PATH form)
      cmake_path(GET form PARENT_PATH module_form_folder)
      list(APPEND module_form_folders ${module_form_folder})
    endforeach()
    set_target_properties(qSlicer${module_NAME}Module PROPERTIES AUTOMOC ON AUTORCC ON AUTOUIC ON
      AUTOUIC_SEARCH_PATHS "${module_form_folders}")
  endif()
  set_target_properties(qSlicer${module_NAME}Module PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${Slicer_QTLOADABLEMODULES_LIB_DIR})
  target_link_libraries(qSlicer${module_NAME}Module PUBLIC ${module_TARGET_LIBRARIES} ${Slicer_GUI_LIBRARY})
  install(TARGETS qSlicer${module_NAME}Module LIBRARY DESTINATION ${Slicer_INSTALL_QTLOADABLEMODULES_LIB_DIR})
endmacro()
