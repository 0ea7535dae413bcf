#pragma once

// What voyager.hpp does in a source file that is compiled without exceptions: NULL, or what is
// wrong. `scene` is a file.
const char* use_without_exceptions(const char* scene);
