# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# The package that other projects find with find_package(HandEyeCalibration).
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/HandEyeCalibration)
install(EXPORT HandEyeTargets NAMESPACE HandEye:: DESTINATION ${config_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/HandEyeCalibrationConfig.cmake.in
  ${PROJECT_BINARY_DIR}/HandEyeCalibrationConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/HandEyeCalibrationConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/HandEyeCalibrationConfig.cmake ${PROJECT_BINARY_DIR}/HandEyeCalibrationConfigVersion.cmake
  DESTINATION ${config_dir})
