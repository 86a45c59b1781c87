// A Vulkan layer that makes calls fail, under a program that knows nothing of it. The environment says
//   TACHYLITE_FAULT=CALL:N:RESULT[:TIMES]   e.g. vkQueueSubmit:3:-4
// the N-th to (N + TIMES - 1)-th call of that name (TIMES is 1 where it lacks) return the VkResult without being made.
// All instances and devices are of one driver, whose functions lie below.

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <vulkan/vk_layer.h>

namespace {

VkResult fault(const char* call) {
  static const char* const plan = std::getenv("TACHYLITE_FAULT");
  static std::atomic<int> calls = 0;
  char name[64] = "";
  int first = 0, result = 0, times = 1;
  if (!plan || std::sscanf(plan, "%63[^:]:%d:%d:%d", name, &first, &result, &times) < 3) return VK_SUCCESS;
  if (std::strcmp(call, name) != 0) return VK_SUCCESS;
  const int call_number = ++calls;
  return call_number >= first && call_number < first + times ? static_cast<VkResult>(result) : VK_SUCCESS;
}

PFN_vkGetInstanceProcAddr next_instance_proc = nullptr;
PFN_vkGetDeviceProcAddr next_device_proc = nullptr;

// The call below us and what stands in for it.
template <class Function>
struct Faulty;
template <class... Arguments>
struct Faulty<VkResult(VKAPI_PTR*)(Arguments...)> {
  using Function = VkResult(VKAPI_PTR*)(Arguments...);
  template <int kId>
  struct Named {
    static inline Function next = nullptr;
    static inline const char* name = nullptr;
    static VKAPI_ATTR VkResult VKAPI_CALL invoke(Arguments... arguments) {
      const VkResult result = fault(name);
      return result == VK_SUCCESS ? next(arguments...) : result;
    }
  };
};

#define DEVICE_CALLS(X)                                                                                              \
  X(vkAllocateMemory) X(vkCreateBuffer) X(vkBindBufferMemory) X(vkMapMemory) X(vkCreateBufferView)                   \
  X(vkCreateShaderModule) X(vkCreateComputePipelines) X(vkCreatePipelineLayout) X(vkCreateDescriptorSetLayout)       \
  X(vkCreateDescriptorPool) X(vkAllocateDescriptorSets) X(vkCreateCommandPool) X(vkAllocateCommandBuffers)           \
  X(vkResetCommandPool) X(vkBeginCommandBuffer) X(vkEndCommandBuffer) X(vkCreateFence) X(vkResetFences)              \
  X(vkWaitForFences) X(vkQueueSubmit) X(vkQueueWaitIdle) X(vkCreateQueryPool) X(vkGetQueryPoolResults)

enum CallId {
#define ID(call) k_##call,
  DEVICE_CALLS(ID)
#undef ID
};
#define NAMED(call) Faulty<PFN_##call>::Named<k_##call>

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  if (const VkResult result = fault("vkCreateDevice"); result != VK_SUCCESS) return result;
  auto* link = const_cast<VkLayerDeviceCreateInfo*>(static_cast<const VkLayerDeviceCreateInfo*>(create->pNext));
  while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
    link = const_cast<VkLayerDeviceCreateInfo*>(static_cast<const VkLayerDeviceCreateInfo*>(link->pNext));
  const PFN_vkGetInstanceProcAddr instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto next = reinterpret_cast<PFN_vkCreateDevice>(instance_proc(VK_NULL_HANDLE, "vkCreateDevice"));
  const VkResult result = next(physical, create, allocator, device);
  if (result != VK_SUCCESS) return result;
#define LOAD(call)                                                                        \
  NAMED(call)::name = #call;                                                              \
  NAMED(call)::next = reinterpret_cast<PFN_##call>(next_device_proc(*device, #call));
  DEVICE_CALLS(LOAD)
#undef LOAD
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* create, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  if (const VkResult result = fault("vkCreateInstance"); result != VK_SUCCESS) return result;
  auto* link = const_cast<VkLayerInstanceCreateInfo*>(static_cast<const VkLayerInstanceCreateInfo*>(create->pNext));
  while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
    link = const_cast<VkLayerInstanceCreateInfo*>(static_cast<const VkLayerInstanceCreateInfo*>(link->pNext));
  next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto next = reinterpret_cast<PFN_vkCreateInstance>(next_instance_proc(VK_NULL_HANDLE, "vkCreateInstance"));
  return next(create, allocator, instance);
}

PFN_vkVoidFunction own_device_call(const char* name) {
#define FIND(call) \
  if (std::strcmp(name, #call) == 0) return reinterpret_cast<PFN_vkVoidFunction>(NAMED(call)::invoke);
  DEVICE_CALLS(FIND)
#undef FIND
  return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(device_proc);
  const PFN_vkVoidFunction own = own_device_call(name);
  return own ? own : next_device_proc(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(instance_proc);
  if (std::strcmp(name, "vkCreateInstance") == 0) return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
  if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(create_device);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(device_proc);
  const PFN_vkVoidFunction own = own_device_call(name);
  if (own) return own;
  return instance && next_instance_proc ? next_instance_proc(instance, name) : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
  version->loaderLayerInterfaceVersion = 2;
  version->pfnGetInstanceProcAddr = instance_proc;
  version->pfnGetDeviceProcAddr = device_proc;
  version->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
