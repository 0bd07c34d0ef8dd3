/* In the place of NLopt's file of this name, whose sort leaves equal elements in any order. SBPLX sorts its steps,
 * which are equal at first, and glibc keeps their order: so it does here, or searches of more than six coordinates
 * would end elsewhere. */
#include <stddef.h>
#include <string.h>

#include "nlopt-util.h"

/* By insertion: there are as many elements as a search has coordinates. */
void nlopt_qsort_r(void* base, size_t count, size_t size, void* context,
                   int (*compare)(void*, const void*, const void*)) {
  char element[256];
  char* const first = base;
  for (size_t k = 1; k < count; ++k) {
    char* place = first + k * size;
    memcpy(element, place, size);
    for (; place > first && compare(context, place - size, element) > 0; place -= size)
      memcpy(place, place - size, size);
    memcpy(place, element, size);
  }
}
