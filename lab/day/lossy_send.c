/* Loses one of so many datagrams that a program sends: cc -shared -fPIC -O2 lossy_send.c -o lossy_send.so -ldl, then
 * LOSE_PER_10000=100 LD_PRELOAD=./lossy_send.so PROGRAM. A proxy between the two sides would not do: DDS tells the other side
 * which address to send to. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/socket.h>

ssize_t sendmsg(int socket, const struct msghdr* message, int flags) {
  static ssize_t (*next)(int, const struct msghdr*, int);
  static int per_10000 = -1;
  static atomic_uint_fast64_t count;
  uint64_t dice;
  if (next == NULL) {
    const char* wanted = getenv("LOSE_PER_10000");
    *(void**)&next = dlsym(RTLD_NEXT, "sendmsg");
    per_10000 = wanted != NULL ? atoi(wanted) : 0;
  }
  dice = (atomic_fetch_add(&count, 1) + 1) * 0x9E3779B97F4A7C15u;
  dice = (dice ^ (dice >> 30)) * 0xBF58476D1CE4E5B9u;
  dice ^= dice >> 31;
  if ((int)(dice % 10000u) < per_10000) {
    size_t size = 0;
    size_t i;
    for (i = 0; i < message->msg_iovlen; ++i) {
      size += message->msg_iov[i].iov_len;
    }
    return (ssize_t)size;
  }
  return next(socket, message, flags);
}
