// scene SCENE: what voyager.hpp says of a scene, and of one that is not there.
#include <cstdio>
#include <voyager/voyager.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = VOY_BACKEND_CPU;
  const voy::Device device = voy::Device::create(desc);
  const voy::Scene scene = device.open_scene(argv[1]);
  std::printf("scene: %llu Gaussians\n",
              static_cast<unsigned long long>(scene.info().gaussianCount));
  try {
    device.open_scene("no such file");
  } catch (const voy::Error& error) {  // thrown by the header, in this program
    return error.result() == VOY_ERROR_FILE_NOT_FOUND ? 0 : 1;
  }
  return 1;
}
