/* The smallest host: loads the plugin, opens a scene, renders one frame from
 * outside its bounds, and writes a PNG.
 *
 *   c_minimal SCENE.voy|.ply|.spz OUT.png [path of libvoyager.so]
 *
 * Exit status: 0 done, 1 bad usage, 2 the scene was refused, 4 anything else. */
#define _XOPEN_SOURCE 700 /* readlink, PATH_MAX */

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <voyager/voyager.h>

enum { kWidth = 960, kHeight = 540 };

/* The entry points that this host uses, found by name at run time. */
static PFN_voyCreateDevice create_device;
static PFN_voyDestroyDevice destroy_device;
static PFN_voyOpenScene open_scene;
static PFN_voyGetSceneInfo get_scene_info;
static PFN_voyCreateView create_view;
static PFN_voyCreateTarget create_target;
static PFN_voyRenderFrame render_frame;
static PFN_voyGetLastErrorMessage last_error;

static int find(void* library, const char* name, void* function) {
  void* symbol = dlsym(library, name);
  if (!symbol) fprintf(stderr, "c_minimal: %s\n", dlerror());
  memcpy(function, &symbol, sizeof symbol); /* POSIX: a function fits in a void* */
  return symbol != NULL;
}

static void* load(const char* path) {
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    fprintf(stderr, "c_minimal: %s\n", dlerror());
    return NULL;
  }
  if (find(library, "voyCreateDevice", &create_device) &&
      find(library, "voyDestroyDevice", &destroy_device) &&
      find(library, "voyOpenScene", &open_scene) &&
      find(library, "voyGetSceneInfo", &get_scene_info) &&
      find(library, "voyCreateView", &create_view) &&
      find(library, "voyCreateTarget", &create_target) &&
      find(library, "voyRenderFrame", &render_frame) &&
      find(library, "voyGetLastErrorMessage", &last_error))
    return library;
  dlclose(library);
  return NULL;
}

/* Prints what a call that failed says was wrong. */
static int succeeded(VoyResult result) {
  if (result < 0) fprintf(stderr, "c_minimal: %s\n", last_error());
  return result >= 0;
}

/* Looks at the centre of the bounds from behind and above. Captured scenes have
 * y down and z forward; poses are OpenXR's, whose camera looks along -z with y
 * up: half a turn about x takes one to the other, less the downward tilt. */
static VoyFrameEye frame_bounds(const VoySceneInfo* info, VoyTarget target) {
  const double half_turn = 3.14159265358979323846, tilt = 0.5;
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  double centre[3], squared = 0, distance;
  int i;
  for (i = 0; i < 3; ++i) {
    const double side = info->boundsMax[i] - info->boundsMin[i];
    centre[i] = info->boundsMin[i] + side / 2;
    squared += side * side;
  }
  distance = 0.4 * sqrt(squared);
  eye.pose.position[0] = centre[0];
  eye.pose.position[1] = centre[1] - distance * sin(tilt);
  eye.pose.position[2] = centre[2] - distance * cos(tilt);
  eye.pose.orientation[0] = sin((half_turn - tilt) / 2);
  eye.pose.orientation[1] = 0;
  eye.pose.orientation[2] = 0;
  eye.pose.orientation[3] = cos((half_turn - tilt) / 2);
  eye.frustum.right = 0.6;
  eye.frustum.left = -eye.frustum.right;
  eye.frustum.up = eye.frustum.right * kHeight / kWidth;
  eye.frustum.down = -eye.frustum.up;
  eye.target = target;
  return eye;
}

/* Everything between the device and the pixels. Returns the exit status. What it
 * makes belongs to the device, and goes with it. */
static int render(VoyDevice device, const char* path, unsigned char* pixels) {
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  VoyFrame frame = VOY_FRAME_INIT;
  VoyFrameEye eye;
  VoyScene scene;
  VoyTarget target;
  VoyView view;

  /* The scene: the file is read, checked and decoded here. */
  scene_desc.path = path;
  if (!succeeded(open_scene(device, &scene_desc, &scene))) return 2;
  if (!succeeded(get_scene_info(scene, &info))) return 4;
  printf("%s: %llu Gaussians\n", path, (unsigned long long)info.gaussianCount);

  /* The target: our own memory, written during render_frame only. */
  target_desc.width = kWidth;
  target_desc.height = kHeight;
  target_desc.color = pixels;
  if (!succeeded(create_target(device, &target_desc, &target))) return 4;

  /* The view: what to draw, how finely; it keeps its cut from frame to frame. */
  view_desc.instanceCount = 1;
  view_desc.scenes = &scene;
  view_desc.maxWidth = kWidth;
  view_desc.maxHeight = kHeight;
  if (!succeeded(create_view(device, &view_desc, &view))) return 4;

  /* The frame: a pose, a frustum and a target for each eye. A host does this in
   * its loop; here is one. */
  eye = frame_bounds(&info, target);
  frame.eyeCount = 1;
  frame.eyes = &eye;
  return succeeded(render_frame(view, &frame)) ? 0 : 4;
}

/* What symbolic links at `path` lead to, whether it is there or not: the picture is written there.
 * `place` has PATH_MAX characters. */
static int follow_links(const char* path, char* place) {
  char next[PATH_MAX];
  int links;
  snprintf(place, PATH_MAX, "%s", path);
  for (links = 0; links < 40; ++links) { /* as many as the system follows */
    const ssize_t length = readlink(place, next, sizeof next - 1);
    char* name = strrchr(place, '/');
    if (length < 0) return 1;
    next[length] = 0;
    name = next[0] == '/' || !name ? place : name + 1;
    snprintf(name, (size_t)(place + PATH_MAX - name), "%s", next);
  }
  fprintf(stderr, "c_minimal: %s: found symbolic links in a circle, expected a file\n", path);
  return 0;
}

/* Before the work: can a file be put there, and is nothing there that no picture may replace, such
 * as a directory, a FIFO or a device? */
static int is_writable(const char* path, const char* place) {
  char folder[PATH_MAX];
  char* slash;
  struct stat info;
  if (stat(place, &info) == 0 && !S_ISREG(info.st_mode)) {
    fprintf(stderr, "c_minimal: %s: found no regular file, expected one or a free name\n", path);
    return 0;
  }
  snprintf(folder, sizeof folder, "%s", place);
  slash = strrchr(folder, '/');
  snprintf(slash ? slash + 1 : folder, 2, "%s", slash ? "" : ".");
  if (access(folder, W_OK) == 0 && (access(place, W_OK) == 0 || errno == ENOENT)) return 1;
  fprintf(stderr, "c_minimal: %s: %s\n", path, strerror(errno));
  return 0;
}

/* The same file by whatever names; what is not there yet is no scene. */
static int is_scene(const char* path, const char* place, const char* scene) {
  struct stat from, to;
  if (stat(scene, &from) != 0 || stat(place, &to) != 0) return 0;
  if (from.st_dev != to.st_dev || from.st_ino != to.st_ino) return 0;
  fprintf(stderr, "c_minimal: %s: found it as the output and as the scene, expected two files\n",
          path);
  return 1;
}

/* Whole or not at all: beside its place first, under a name that no file has. */
static int write_png(const char* path, const char* place, const unsigned char* pixels) {
  char beside[PATH_MAX + 32];
  FILE* file;
  int written;
  png_image image;
  snprintf(beside, sizeof beside, "%s.part-%ld", place, (long)getpid());
  memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = kWidth;
  image.height = kHeight;
  image.format = PNG_FORMAT_RGBA;
  file = fopen(beside, "wbx"); /* x: fails where there is one */
  written = file && png_image_write_to_stdio(&image, file, 0, pixels, 0, NULL);
  if (file && fclose(file) != 0) written = 0;
  if (written && rename(beside, place) == 0) return 0;
  fprintf(stderr, "c_minimal: %s: %s\n", path, image.message[0] ? image.message : strerror(errno));
  if (file) remove(beside);
  return 4;
}

int main(int argc, char** argv) {
  VoyDeviceDesc device_desc = VOY_DEVICE_DESC_INIT;
  VoyDevice device;
  char place[PATH_MAX];
  unsigned char* pixels;
  void* library;
  size_t i;
  int status = 4;
  if (argc < 3 || argc > 4) {
    fprintf(stderr, "usage: c_minimal SCENE.voy|.ply|.spz OUT.png [path of libvoyager.so]\n");
    return 1;
  }
  if (!follow_links(argv[2], place)) return 4;
  if (is_scene(argv[2], place, argv[1])) return 1;
  if (!is_writable(argv[2], place)) return 4;
  library = load(argc == 4 ? argv[3] : VOYAGER_LIBRARY);
  if (!library) return 4;

  /* The device: a backend, here the fastest that the machine has. */
  pixels = malloc((size_t)kWidth * kHeight * 4);
  if (pixels && succeeded(create_device(&device_desc, &device))) {
    status = render(device, argv[1], pixels);
    destroy_device(device);
  }
  /* The background is opaque, so the picture is: alpha says how much of it is scene. */
  for (i = 0; status == 0 && i < (size_t)kWidth * kHeight; ++i) pixels[4 * i + 3] = 255;
  if (status == 0) status = write_png(argv[2], place, pixels);
  free(pixels);
  dlclose(library);
  return status;
}
