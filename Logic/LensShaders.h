// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Private to the overlay: the shader texts of vtkHandEyeLensMapper. Features are chosen by #define, not by uniforms: software
/// renderers execute both sides of a branch.
namespace handeye::shaders
{

/// CameraModel::distort(), for either stage.
constexpr const char* Distort = R"glsl(
vec2 lensDistort(vec2 n, float k[14], mat3 tilt)
{
  float r2 = dot(n, n);
  float numerator = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  float denominator = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  vec2 tangential = 2.0 * n.x * n.y * vec2(k[2], k[3]) + (r2 + 2.0 * n * n) * vec2(k[3], k[2]);
  vec2 prism = r2 * vec2(k[8] + r2 * k[9], k[10] + r2 * k[11]);
  vec2 bent = n * numerator / denominator + tangential + prism;
  vec3 tilted = tilt * vec3(bent, 1.0);
  return tilted.xy / tilted.z;
}
)glsl";

/// Two passes (depth, then colour) must agree on the depth to the last bit, hence invariant.
/// lensWarp(): view coordinates (x right, y up, z backward) in, view coordinates out.
constexpr const char* WarpDeclaration = R"glsl(
invariant gl_Position;
out vec4 vertexVCVSOutput;
uniform mat4 lensVCDCMatrix;
#ifdef LENS_BENT
uniform float lensK[14];
uniform mat3 lensTilt;
uniform float lensLimitRadius;
uniform float lensOuterSlope;

vec4 lensWarp(vec4 position)
{
  vec2 offset = vec2(position.x, -position.y);
  float depth = max(-position.z, 0.0);
  float radius = length(offset);
  float believed = lensLimitRadius * depth;
  bool inside = depth > 0.0 && radius <= believed;
  vec2 outward = radius > 0.0 ? offset / radius : vec2(0.0);
  vec2 warped = depth * lensDistort(inside ? offset / depth : lensLimitRadius * outward, lensK, lensTilt);
  warped += inside ? vec2(0.0) : lensOuterSlope * (radius - believed) * outward;
  return vec4(warped.x, -warped.y, position.zw);
}
#else
vec4 lensWarp(vec4 position)
{
  return position;
}
#endif
#ifdef LENS_LOOKUP
// Where the straightened video has what is seen at a vertex, 0 to 1 from the lower left: the edges between are as straight as those
// of a mesh on a raw video, the triangles being small enough for the one as for the other.
uniform float lookupK[14];
uniform mat3 lookupTilt;
uniform vec4 lookupPinhole;
uniform vec2 lensVideoSize;
noperspective out vec2 lensVideoPlaceVS;

vec2 lensVideoPlace(vec3 position)
{
  vec2 bent = lensDistort(vec2(position.x, -position.y) / max(-position.z, 1e-6), lookupK, lookupTilt);
  vec2 seen = (bent * lookupPinhole.xy + lookupPinhole.zw + 0.5) / lensVideoSize;
  return vec2(seen.x, 1.0 - seen.y);
}
#endif
)glsl";

constexpr const char* WarpImplementation = R"glsl(
  vertexVCVSOutput = MCVCMatrix * vertexMC;
  gl_Position = lensVCDCMatrix * lensWarp(vertexVCVSOutput);
#ifdef LENS_LOOKUP
  lensVideoPlaceVS = lensVideoPlace(vertexVCVSOutput.xyz);
#endif
#ifdef LENS_BEHIND
  gl_Position.z += 0.01 * gl_Position.w;
#endif
)glsl";

constexpr const char* FragmentDeclaration = R"glsl(
in vec4 vertexVCVSOutput;
uniform float lensLimitRadius;
)glsl";

/// The true position of this fragment, not the warped one, decides whether the lens model can be believed there. Only where the
/// mesh reaches that far: a shader that can discard is run before the depth test, for hidden surfaces too.
constexpr const char* LimitImplementation = R"glsl(
#ifdef LENS_LIMIT
  if (vertexVC.z >= 0.0 || dot(vertexVC.xy, vertexVC.xy) > lensLimitRadius * lensLimitRadius * vertexVC.z * vertexVC.z)
  {
    discard;
  }
#endif
#ifdef LENS_CLIP
  if (-vertexVC.z < lensClipDepth)
  {
    discard;
  }
#endif
#ifdef LENS_ROWS
  if (mod(floor(gl_FragCoord.y) + lensRowOffset, 2.0) > 0.5)
  {
    discard;
  }
#endif
  //VTK::Clip::Impl
)glsl";

/// Uniforms and functions of the look. `lensPicture`: x, y, 1/width, 1/height of the picture, device px.
constexpr const char* LookDeclaration = R"glsl(
uniform vec4 lensPicture;
uniform float lensOutputAlpha;
uniform float lensOpacity;
uniform float lensClipDepth;
uniform float lensRowOffset;
uniform float lensRimStrength;
uniform vec2 lensDepthRange;
uniform vec3 lensKeyhole;
uniform float lensGhosting;
uniform sampler2D lensVideo;
uniform vec2 lensVideoSize;
#ifdef LENS_LOOKUP
noperspective in vec2 lensVideoPlaceVS;
#endif

vec3 lensVideoColor(vec2 videoPlace)
{
#ifdef LENS_LOOKUP
  vec2 beyond = abs(videoPlace - 0.5);
  if (max(beyond.x, beyond.y) > 0.5)
  {
    return vec3(0.0);
  }
#endif
  return texture(lensVideo, videoPlace).rgb;
}

float lensLuma(vec3 color)
{
  return dot(color, vec3(0.299, 0.587, 0.114));
}

// How much of an edge the video has here, 0 to 1: Sobel's operator over the neighbouring pixels.
float lensVideoEdge(vec2 videoPlace)
{
  vec2 dx = vec2(1.0 / lensVideoSize.x, 0.0);
  vec2 dy = vec2(0.0, 1.0 / lensVideoSize.y);
  float nw = lensLuma(lensVideoColor(videoPlace - dx + dy)), ne = lensLuma(lensVideoColor(videoPlace + dx + dy));
  float sw = lensLuma(lensVideoColor(videoPlace - dx - dy)), se = lensLuma(lensVideoColor(videoPlace + dx - dy));
  float n = lensLuma(lensVideoColor(videoPlace + dy)), s = lensLuma(lensVideoColor(videoPlace - dy));
  float w = lensLuma(lensVideoColor(videoPlace - dx)), e = lensLuma(lensVideoColor(videoPlace + dx));
  vec2 gradient = vec2(ne + 2.0 * e + se - nw - 2.0 * w - sw, nw + 2.0 * n + ne - sw - 2.0 * s - se);
  return smoothstep(0.08, 0.5, length(gradient));
}

// Red, yellow, green, cyan, blue.
vec3 lensDepthColor(float share)
{
  vec3 color = abs(vec3(4.0 * share - 3.0, 4.0 * share - 2.0, 4.0 * share - 1.0));
  return clamp(vec3(2.0 - 4.0 * share, 2.0 - color.y, 4.0 * share - 2.0), 0.0, 1.0);
}
)glsl";

/// The outline of anatomy: a surface seen edge-on is darkened and made opaque. Only where there are normals.
constexpr const char* RimImplementation = R"glsl(
  float lensFacing = 1.0 - min(abs(dot(normalVCVSOutput, normalize(vertexVC.xyz))), 1.0);
  float lensRim = lensFacing * lensFacing * lensFacing * lensRimStrength;
)glsl";

constexpr const char* NoRimImplementation = "  float lensRim = 0.0;\n";

/// The video is mixed in here rather than by blending: the depth test then leaves the foremost surface alone, in one pass.
constexpr const char* LookImplementation = R"glsl(
  vec3 lensColor = gl_FragData[0].rgb;
#ifdef LENS_DEPTHCOLORS
  float lensShare = clamp((-vertexVC.z - lensDepthRange.x) / (lensDepthRange.y - lensDepthRange.x), 0.0, 1.0);
  lensColor = lensDepthColor(lensShare) * (0.35 + 0.65 * lensLuma(lensColor));
#endif
#ifdef LENS_CLIP
  if (!gl_FrontFacing)
  {
    lensColor *= vec3(0.9, 0.4, 0.35);
  }
#endif
  lensColor *= 1.0 - 0.75 * lensRim;
#ifdef LENS_MIX
  float lensAlpha = mix(lensOpacity, 1.0, lensRim);
  vec2 lensPlace = (gl_FragCoord.xy - lensPicture.xy) * lensPicture.zw;
#ifdef LENS_KEYHOLE
  float lensAway = length((lensPlace - lensKeyhole.xy) / lensPicture.zw) / lensKeyhole.z;
  lensAlpha *= 1.0 - smoothstep(0.92, 1.0, lensAway);
#endif
#ifdef LENS_VIDEO
#ifdef LENS_LOOKUP
  vec2 lensVideoHere = lensVideoPlaceVS;
#else
  vec2 lensVideoHere = lensPlace;
#endif
#ifdef LENS_GHOSTING
  lensAlpha *= 1.0 - lensGhosting * lensVideoEdge(lensVideoHere);
#endif
  lensColor = mix(lensVideoColor(lensVideoHere), lensColor, lensAlpha);
#else
  lensColor *= lensAlpha;
#endif
#endif
#ifdef LENS_LUMA
  lensColor = vec3(lensLuma(lensColor));
#endif
#ifdef LENS_COMPOSE
  gl_FragData[0] = vec4(lensColor, lensOutputAlpha);
#else
  gl_FragData[0] = vec4(lensColor, mix(gl_FragData[0].a, 1.0, lensRim));
#endif
  //VTK::TCoord::Impl
)glsl";

}  // namespace handeye::shaders
