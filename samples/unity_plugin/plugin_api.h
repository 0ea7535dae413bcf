#pragma once
// What a C# script calls, beside UnityPluginLoad and UnityPluginUnload, which Unity calls. All of
// it may be called on the main thread while the rendering thread draws. docs/unity.md has the
// script.
#include <cstdint>

#include "unity_interfaces.h"

struct VoyUnityStats {
  uint64_t frame;       // frames that were drawn, counted from 0
  uint64_t splats;      // that contribute to the picture
  double milliseconds;  // that the frame took Voyager
  double tau;           // pixels
};

extern "C" {
// Opens a scene in place of the one before: a file or a URL, UTF-8. It blocks until the scene is
// open. Returns 1, or 0 with an error.
UNITY_INTERFACE_EXPORT int UNITY_INTERFACE_API voyUnityOpenScene(const char* path);
UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API voyUnityCloseScene();

// Says what the next event draws, and where. Returns the data for
// CommandBuffer.IssuePluginEventAndData, valid for the next 16 calls; NULL for a camera that
// Voyager refuses (voyUnityLastError), with which the event draws nothing. Matrices are
// Camera.cameraToWorldMatrix and Camera.projectionMatrix, lengths are metres.
// colour: Texture.GetNativeTexturePtr() of a RenderTexture that the splats are blended over. Its
// first row is the bottom of the picture, as Unity draws with Vulkan.
// depth: the same of a RenderTexture of format Depth and the same size, which hides splats behind
// it, or NULL.
UNITY_INTERFACE_EXPORT void* UNITY_INTERFACE_API voyUnityCamera(const float* camera_to_world,
                                                                const float* projection,
                                                                float near_z, float far_z,
                                                                void* colour, void* depth);
// For CommandBuffer.IssuePluginEventAndData.
UNITY_INTERFACE_EXPORT UnityRenderingEventAndData UNITY_INTERFACE_API voyUnityRenderEvent();
UNITY_INTERFACE_EXPORT int UNITY_INTERFACE_API voyUnityEventId();

// Of the last finished frame. Returns 1, or 0 with an error.
UNITY_INTERFACE_EXPORT int UNITY_INTERFACE_API voyUnityStatistics(VoyUnityStats* stats);

// Copies the last error of any call or event, cut to `capacity` bytes with the terminating 0: ""
// if there was none. UTF-8. Errors never stop Unity: the event draws nothing.
UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API voyUnityLastError(char* text, int capacity);
}
