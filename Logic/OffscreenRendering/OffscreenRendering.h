// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace handeye
{

/// From now on every vtkRenderWindow of this process renders into memory, through OSMesa, and needs no X server: for programs
/// without windows of their own, such as the command line and the image tests. Call it before the first render window is made;
/// calling it again does nothing.
///
/// Only for programs, never for a plugin or a desktop: the target HandEye::OffscreenRendering also answers, for the whole process,
/// the questions that GLEW puts to GLX.
///
/// Contexts belong to the thread that renders; use one thread.
void registerOffscreenRendering();

}  // namespace handeye
