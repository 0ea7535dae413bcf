// backends: without exceptions and RTTI, as engines build. Prints what became of each module.
#include <voyager/voyager.h>

#include <cstdio>

static const char* outcome(VoyResult result) {
  return result < 0 ? voyGetLastErrorMessage() : voyResultName(result);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::printf("cuda: %s\n", outcome(voyQueryBackend(VOY_BACKEND_CUDA)));

  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = VOY_BACKEND_CPU;
  VoyDevice device = nullptr;
  if (voyCreateDevice(&desc, &device) < 0) return 1;
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.path = "http://";  // what libcurl refuses, so that the module was asked
  VoyScene scene = nullptr;
  std::printf("http: %s\n", outcome(voyOpenScene(device, &scene_desc, &scene)));
  scene_desc.path = argv[1];  // a damaged .sog
  std::printf("sog: %s\n", outcome(voyOpenScene(device, &scene_desc, &scene)));
  return voyDestroyDevice(device) < 0;
}
