/* Around the C of docs/streaming.md: what its text has before. */
#include <voyager/voyager.h>

void open_city(VoyDevice device, double position[3]);
void open_city(VoyDevice device, double position[3]) {
  struct {
    double* position;
  } player;
  VoyScene scene;
  player.position = position;
#include "snippet.h"
}
