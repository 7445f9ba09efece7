# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# In a build for 3D Slicer: its libraries under the names by which ours ask for base classes.
add_library(HandEyeSlicerBase INTERFACE)
add_library(HandEye::SlicerBase ALIAS HandEyeSlicerBase)
target_link_libraries(HandEyeSlicerBase INTERFACE SlicerBaseLogic MRMLLogic MRMLCore)
target_include_directories(HandEyeSlicerBase SYSTEM INTERFACE ${Slicer_Libs_INCLUDE_DIRS} ${Slicer_Base_INCLUDE_DIRS})
