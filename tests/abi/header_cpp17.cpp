// The headers as C++17; every inline function of voyager.hpp is instantiated.
#include <voyager/voyager_vulkan.h>
#include <voyager/voyager.hpp>

#include <type_traits>

static_assert(!std::is_copy_constructible_v<voy::Device>);
static_assert(std::is_nothrow_move_constructible_v<voy::Scene>);
static_assert(std::is_nothrow_move_assignable_v<voy::View>);
static_assert(std::is_base_of_v<std::runtime_error, voy::Error>);
