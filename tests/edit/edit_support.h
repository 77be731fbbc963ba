/* What the tests of sessions share: random actions and the invariants that hold after every action. */
#ifndef SL_TESTS_EDIT_SUPPORT_H
#define SL_TESTS_EDIT_SUPPORT_H

#include "edit/session.h"
#include "support/test_support.h"

/* The first invariant that is broken, as a text; NULL = all hold: each facet in one chart, charts connected disks, UVs
 * finite, equal along uncut edges, nothing flipped, copies where what they show is, pointers in order. */
const char *edit_broken(const sl_session *session);

/* Some action that makes sense more often than not. */
sl_action edit_random_action(const sl_session *session, test_rng *rng);

#endif
