/* A controller that reads nothing of depthgrid but its datagrams, in C.
 *
 *   cc -std=c99 -O2 -I .. datagram_reader.c -o datagram_reader      (-I ..: where depthgrid is not installed)
 *   ./datagram_reader 47000 5            # in another shell: depthgrid run CELL, with outputs: {udp: {port: 47000}}
 *
 * What a controller has to see to by itself: an answer that does not come, comes late, or says stop. Here 20 ms without
 * one count as stop. Exit code: 0 when answers came, 1 otherwise. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "depthgrid/network/datagram.h"

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char** argv) {
  const int port = argc > 1 ? atoi(argv[1]) : 47000;
  const double seconds = argc > 2 ? atof(argv[2]) : 5.0;
  const int most_silent_ms = 20;
  struct sockaddr_in here = {0};
  struct depthgrid_answer answer = {0};
  unsigned char bytes[2048];
  unsigned long answers = 0;
  unsigned long stops = 0;
  unsigned long silent = 0;
  unsigned long missed = 0;
  unsigned long refused = 0;
  uint64_t last = 0;
  double next_line_s = now_s();
  const double end_s = now_s() + seconds;
  const int incoming = socket(AF_INET, SOCK_DGRAM, 0);

  here.sin_family = AF_INET;
  here.sin_port = htons((uint16_t)port);
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK); /* INADDR_ANY for another computer's */
  if (incoming < 0 || bind(incoming, (const struct sockaddr*)&here, sizeof here) != 0) {
    perror("datagram_reader");
    return 1;
  }
  while (now_s() < end_s) {
    struct pollfd wait = {incoming, POLLIN, 0};
    if (poll(&wait, 1, most_silent_ms) != 1) {
      ++silent; /* stop here: nothing was heard for 20 ms */
      continue;
    }
    const ssize_t size = recv(incoming, bytes, sizeof bytes, 0);
    if (size < 0 || depthgrid_read_datagram(bytes, (size_t)size, &answer) != DEPTHGRID_DATAGRAM_OK) {
      ++refused;
      continue;
    }
    if (answer.sequence <= last && answers > 0) {
      ++refused; /* late, doubled, or the sender began anew: not used */
      last = answer.sequence;
      continue;
    }
    missed += answers > 0 ? (unsigned long)(answer.sequence - last - 1) : 0;
    last = answer.sequence;
    ++answers;
    stops += answer.stop;
    if (now_s() >= next_line_s) {
      printf("%s %.3f m, state %d, %.1f ms after the exposure\n", answer.stop ? "stop" : "go  ", answer.distance_m,
             answer.state, 1e3 * answer.latency_s);
      next_line_s += 1.0;
    }
  }
  printf("%lu answers, %lu of them stop; %lu missed, %lu refused, %lu times silent for %d ms\n", answers, stops, missed,
         refused, silent, most_silent_ms);
  close(incoming);
  return answers > 0 ? 0 : 1;
}
