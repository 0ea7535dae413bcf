// voyGetViewOmissions: what a view does without.
#include <algorithm>

#include "plugin/call.h"
#include "plugin/claim.h"
#include "plugin/objects.h"
#include "plugin/structs.h"
#include "plugin/text.h"

using namespace voyager;

namespace {

VoyOmission omission_of(const Omission& omission, double bytes_a_second) {
  VoyOmission out = {VOY_STRUCTURE_TYPE_OMISSION, nullptr, omission.bytes, 0, {}, {}};
  if (bytes_a_second > 0)
    out.milliseconds = static_cast<double>(omission.frame_bytes) / bytes_a_second * 1e3;
  put_text(omission.what, out.what);
  put_text(omission.why, out.why);
  return out;
}

}  // namespace

VoyResult VOY_CALL voyGetViewOmissions(VoyView view, uint32_t capacity, VoyOmission* omissions,
                                       uint32_t* count) {
  return guarded("voyGetViewOmissions", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(omissions, "omissions");
    const auto frame = claim(*object);
    const std::vector<Omission> found = object->view->omissions();
    const double rate = object->device().backend->rates().bytes;
    const size_t written = std::min<size_t>(capacity, found.size());
    for (size_t i = 0; i < written; ++i) omissions[i] = omission_of(found[i], rate);
    *count = static_cast<uint32_t>(found.size());
    return capacity > 0 && written < found.size() ? VOY_INCOMPLETE : VOY_SUCCESS;
  });
}
