// The headers as C++17; every inline function of voyager.hpp is instantiated.
#include <voyager/voyager_experiment.h>
#include <voyager/voyager_vulkan.h>
#include <voyager/voyager.hpp>

#include <type_traits>

static_assert(!std::is_copy_constructible_v<voy::Device>);
static_assert(std::is_nothrow_move_constructible_v<voy::Scene>);
static_assert(std::is_nothrow_move_assignable_v<voy::View>);
static_assert(std::is_base_of_v<std::runtime_error, voy::Error>);

// Each function has the type that its header gives to hosts that load it at run time.
#define VOY_TEST_TYPE(function) static_assert(std::is_same_v<PFN_##function, decltype(&function)>)
VOY_TEST_TYPE(voyCloseScene);
VOY_TEST_TYPE(voyCreateDevice);
VOY_TEST_TYPE(voyCreateTarget);
VOY_TEST_TYPE(voyCreateView);
VOY_TEST_TYPE(voyCreateVulkanComposite);
VOY_TEST_TYPE(voyDestroyDevice);
VOY_TEST_TYPE(voyDestroyTarget);
VOY_TEST_TYPE(voyDestroyView);
VOY_TEST_TYPE(voyDestroyVulkanComposite);
VOY_TEST_TYPE(voyEnumerateDevices);
VOY_TEST_TYPE(voyFrustumFromAngles);
VOY_TEST_TYPE(voyFrustumFromIntrinsics);
VOY_TEST_TYPE(voyFrustumFromProjection);
VOY_TEST_TYPE(voyGetCapabilities);
VOY_TEST_TYPE(voyGetFrameStats);
VOY_TEST_TYPE(voyGetLastErrorMessage);
VOY_TEST_TYPE(voyGetSceneInfo);
VOY_TEST_TYPE(voyGetSceneNotes);
VOY_TEST_TYPE(voyGetStreamingStats);
VOY_TEST_TYPE(voyGetVersion);
VOY_TEST_TYPE(voyGetViewCut);
VOY_TEST_TYPE(voyGetViewOmissions);
VOY_TEST_TYPE(voyGetVulkanImages);
VOY_TEST_TYPE(voyGetVulkanRequirements);
VOY_TEST_TYPE(voyOpenScene);
VOY_TEST_TYPE(voyPoseFromViewMatrix);
VOY_TEST_TYPE(voyPoseFromWorldMatrix);
VOY_TEST_TYPE(voyQueryBackend);
VOY_TEST_TYPE(voyRecordVulkanAcquire);
VOY_TEST_TYPE(voyRecordVulkanComposite);
VOY_TEST_TYPE(voyRecordVulkanCopy);
VOY_TEST_TYPE(voyRecordVulkanDepthLimit);
VOY_TEST_TYPE(voyRecordVulkanRelease);
VOY_TEST_TYPE(voyRenderFrame);
VOY_TEST_TYPE(voyResultName);
VOY_TEST_TYPE(voySetSceneMemoryBudget);
VOY_TEST_TYPE(voySetViewInstances);
VOY_TEST_TYPE(voySetViewTau);
VOY_TEST_TYPE(voySetViewTimeBudget);
VOY_TEST_TYPE(voyStageName);
#undef VOY_TEST_TYPE
