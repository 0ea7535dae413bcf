/* frame SCENE: draws one frame with whatever the machine has. Succeeds if the picture shows the
 * scene. */
#include <stdio.h>
#include <voyager/voyager.h>

enum { kSide = 64 };
static unsigned char pixels[kSide * kSide * 4];

static int failed(VoyResult result) {
  if (result < 0) fprintf(stderr, "frame: %s\n", voyGetLastErrorMessage());
  return result < 0;
}

/* From 60 m before the origin, as wide as it is high. */
static VoyFrameEye look_at_origin(VoyTarget target) {
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose.position[2] = 60;
  eye.frustum.left = eye.frustum.down = -1;
  eye.frustum.right = eye.frustum.up = 1;
  eye.target = target;
  return eye;
}

static int draw(VoyDevice device, const char* path) {
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  VoyFrame frame = VOY_FRAME_INIT;
  VoyFrameEye eye;
  VoyScene scene;
  VoyTarget target;
  VoyView view;
  scene_desc.path = path;
  target_desc.width = target_desc.height = kSide;
  target_desc.color = pixels;
  if (failed(voyOpenScene(device, &scene_desc, &scene)) ||
      failed(voyCreateTarget(device, &target_desc, &target)))
    return 1;
  view_desc.instanceCount = 1;
  view_desc.scenes = &scene;
  view_desc.maxWidth = view_desc.maxHeight = kSide;
  if (failed(voyCreateView(device, &view_desc, &view))) return 1;
  eye = look_at_origin(target);
  frame.eyeCount = 1;
  frame.eyes = &eye;
  return failed(voyRenderFrame(view, &frame));
}

int main(int argc, char** argv) {
  VoyDeviceDesc device_desc = VOY_DEVICE_DESC_INIT;
  VoyDevice device;
  int covered = 0, i;
  if (argc != 2 || failed(voyCreateDevice(&device_desc, &device))) return 1;
  if (draw(device, argv[1])) return 1;
  voyDestroyDevice(device);
  for (i = 0; i < kSide * kSide; ++i) covered += pixels[4 * i + 3] != 0;
  printf("frame: %d of %d pixels show the scene\n", covered, kSide * kSide);
  return covered == 0;
}
