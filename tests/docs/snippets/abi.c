/* Around the C of docs/abi.md: what its text has before. */
#include <voyager/voyager.h>

void draw_two(VoyView view, VoyScene city, VoyScene statue);
void draw_two(VoyView view, VoyScene city, VoyScene statue) {
#include "snippet.h"
}
