/* A control program in lockstep with `flexsc serve`: packets, repetition and the fields of the sensors. */
#define _POSIX_C_SOURCE 200112L
#ifdef __APPLE__
#define _DARWIN_C_SOURCE /* for SO_NOSIGPIPE */
#endif

#include "flexsc_lockstep.h"

#include <errno.h>
#include <math.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

enum { HELLO = 0x2F0, WELCOME, REFUSAL, REQUEST, SENSORS, COMMAND, END, FAREWELL };

enum { HEADER = 6, CHECKSUM = 2, REPEAT_MS = 20, HELLO_REPEAT_MS = 100, TIMEOUT_MS = 10000 };

/* A server that has gone is an error, and no signal, which would end the program. */
#ifdef MSG_NOSIGNAL
enum { SEND_FLAGS = MSG_NOSIGNAL };
#else
enum { SEND_FLAGS = 0 };
#endif

static int is_telecommand(unsigned kind)
{
    return kind == HELLO || kind == REQUEST || kind == COMMAND || kind == FAREWELL;
}

static int fail(flexsc_client *client, const char *text, const char *detail)
{
    snprintf(client->error, sizeof client->error, "%s%s", text, detail);
    return -1;
}

/* Cyclic redundancy check of 16 bits, x^16 + x^12 + x^5 + 1 from all ones. */
static uint16_t checksum(const unsigned char *data, size_t length)
{
    uint16_t sum = 0xFFFF;
    for (size_t at = 0; at < length; at++) {
        sum = (uint16_t)(sum ^ (uint16_t)(data[at] << 8));
        for (int bit = 0; bit < 8; bit++) {
            sum = (uint16_t)((sum & 0x8000) ? (sum << 1) ^ 0x1021 : sum << 1);
        }
    }
    return sum;
}

static uint64_t read_bits(const unsigned char *data, size_t bytes)
{
    uint64_t value = 0;
    for (size_t at = 0; at < bytes; at++) {
        value = value << 8 | data[at];
    }
    return value;
}

static void write_bits(unsigned char *data, size_t bytes, uint64_t value)
{
    for (size_t at = bytes; at > 0; at--) {
        data[at - 1] = (unsigned char)(value & 0xFF);
        value >>= 8;
    }
}

static int64_t as_signed(uint64_t bits)
{
    int64_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static int64_t now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Sends a packet. One that cannot be sent as a datagram is lost. */
static int send_packet(flexsc_client *client, unsigned kind, const unsigned char *content, size_t length)
{
    unsigned char packet[HEADER + 64 + CHECKSUM];
    uint16_t *count = &client->counts[kind - HELLO];
    size_t size = HEADER + length;
    write_bits(packet, 2, (is_telecommand(kind) ? 0x1000u : 0u) | kind);
    write_bits(packet + 2, 2, 0xC000u | *count);
    write_bits(packet + 4, 2, length + CHECKSUM - 1);
    *count = (uint16_t)((*count + 1) & 0x3FFF);
    memcpy(packet + HEADER, content, length);
    write_bits(packet + size, CHECKSUM, checksum(packet, size));
    size += CHECKSUM;
    for (size_t sent = 0; sent < size;) {
        const ssize_t more = send(client->socket, packet + sent, size - sent, SEND_FLAGS);
        if (more < 0 && errno == EINTR) {
            continue;
        }
        if (more < 0) {
            return client->transport == FLEXSC_UDP ? 0 : fail(client, "the server has gone: ", strerror(errno));
        }
        sent += (size_t)more;
    }
    return 0;
}

/* Returns 1 if the socket has data within a time, 0 if not. */
static int wait_for_data(flexsc_client *client, int64_t ms)
{
    struct pollfd poll_socket = {client->socket, POLLIN, 0};
    return poll(&poll_socket, 1, ms < 0 ? 0 : (int)ms) > 0;
}

/* Reads the bytes of a packet into `received`. Returns their number, 0 if none has come, and -1 at the end of a stream. */
static long read_bytes(flexsc_client *client, int64_t until)
{
    for (;;) {
        if (client->transport == FLEXSC_TCP && client->stream_length >= HEADER) {
            const size_t length = (size_t)read_bits(client->stream + 4, 2) + HEADER + 1;
            if (length > FLEXSC_LONGEST_PACKET) {
                return fail(client, "the stream of the server holds no packets", "");
            }
            if (client->stream_length >= length) {
                memcpy(client->received, client->stream, length);
                client->stream_length -= length;
                memmove(client->stream, client->stream + length, client->stream_length);
                return (long)length;
            }
        }
        if (!wait_for_data(client, until - now_ms())) {
            if (now_ms() >= until) {
                return 0;
            }
            continue;
        }
        if (client->transport == FLEXSC_UDP) {
            const ssize_t count = recv(client->socket, client->received, sizeof client->received, 0);
            return count > 0 ? (long)count : 0;
        }
        const ssize_t count = recv(client->socket, client->stream + client->stream_length,
                                   sizeof client->stream - client->stream_length, 0);
        if (count == 0) {
            return fail(client, "the server has closed the connection", "");
        }
        if (count < 0 && errno != EINTR) {
            return fail(client, "the server has gone: ", strerror(errno));
        }
        client->stream_length += count > 0 ? (size_t)count : 0;
    }
}

/* Waits for a packet that is not damaged. Returns its kind with its content and the length of that, 0 if none has come, and
 * -1 at the end of a stream. */
static int receive_packet(flexsc_client *client, int64_t until, const unsigned char **content, size_t *length)
{
    const long count = read_bytes(client, until);
    const unsigned char *packet = client->received;
    if (count < 0) {
        return -1;
    }
    if (count < HEADER + CHECKSUM || (long)read_bits(packet + 4, 2) + HEADER + 1 != count) {
        return 0;
    }
    const unsigned first = (unsigned)read_bits(packet, 2), kind = first & 0x7FF;
    const size_t body = (size_t)count - CHECKSUM;
    if (kind < HELLO || kind > FAREWELL || first >> 11 != (is_telecommand(kind) ? 2u : 0u) || packet[2] >> 6 != 3
        || read_bits(packet + body, CHECKSUM) != checksum(packet, body)) {
        return 0;
    }
    *content = packet + HEADER;
    *length = body - HEADER;
    return (int)kind;
}

static int refused(flexsc_client *client, const unsigned char *content, size_t length)
{
    const size_t text = length > 8 ? length - 8 : 0;
    const size_t most = sizeof client->error - 1;
    memcpy(client->error, content + (text ? 8 : 0), text < most ? text : most);
    client->error[text < most ? text : most] = '\0';
    return -1;
}

static size_t size_of(char type)
{
    return type == 'b' ? 1 : type == 'w' ? 4 : 8;
}

/* Reads a line `name type components unit` of the layout. */
static int read_field(flexsc_client *client, const char *line)
{
    char type[8], components[1024];
    if (client->field_count == FLEXSC_MOST_FIELDS) {
        return fail(client, "the packets have too many fields for this client", "");
    }
    flexsc_field *field = &client->fields[client->field_count];
    if (sscanf(line, "%63s %7s %1023s %15[^\n]", field->name, type, components, field->unit) != 4) {
        return fail(client, "a field of the layout cannot be read: ", line);
    }
    if (strcmp(field->unit, "-") == 0) {
        field->unit[0] = '\0';
    }
    field->type = strcmp(type, "u8") == 0    ? 'b'
                  : strcmp(type, "u32") == 0 ? 'w'
                  : strcmp(type, "u64") == 0 ? 'u'
                  : strcmp(type, "i64") == 0 ? 'i'
                                             : 'd';
    field->count = 1;
    for (const char *at = components; *at; at++) {
        field->count += *at == ',';
    }
    field->offset = client->content_length;
    client->content_length += size_of(field->type) * (size_t)field->count;
    client->field_count++;
    return 0;
}

/* Reads the description of the packets, which ends with a zero. */
static int read_layout(flexsc_client *client, char *text)
{
    int version;
    long long seconds, femtoseconds;
    char *line = strchr(text, '\n');
    if (!line
        || sscanf(text, "flexsc-lockstep %d axes %d period %lld %lld", &version, &client->axes, &seconds,
                  &femtoseconds) != 4
        || client->axes < 1 || client->axes > 3) {
        return fail(client, "the layout of the packets cannot be read", "");
    }
    client->period_s = seconds;
    client->period_fs = femtoseconds;
    client->content_length = 0;
    client->field_count = 0;
    for (line++; *line;) {
        char *end = strchr(line, '\n');
        if (end) {
            *end = '\0';
        }
        if (read_field(client, line) != 0) {
            return -1;
        }
        if (!end) {
            break;
        }
        line = end + 1;
    }
    return client->content_length <= sizeof client->content ? 0 : fail(client, "the packets are too long", "");
}

static int open_socket(flexsc_client *client, const char *host, uint16_t port)
{
    struct addrinfo hints, *found = NULL;
    char service[8];
    memset(&hints, 0, sizeof hints);
    hints.ai_socktype = client->transport == FLEXSC_TCP ? SOCK_STREAM : SOCK_DGRAM;
    snprintf(service, sizeof service, "%u", (unsigned)port);
    if (getaddrinfo(host, service, &hints, &found) != 0 || !found) {
        return fail(client, "cannot find the host ", host);
    }
    client->socket = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    const int failed = client->socket < 0 || connect(client->socket, found->ai_addr, found->ai_addrlen) != 0;
    freeaddrinfo(found);
    if (failed) {
        return fail(client, "cannot reach the server: ", strerror(errno));
    }
    if (client->transport == FLEXSC_TCP) {
        const int on = 1;
        setsockopt(client->socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
#ifdef SO_NOSIGPIPE
        setsockopt(client->socket, SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
#endif
    }
    return 0;
}

static int greet(flexsc_client *client, uint64_t layout)
{
    unsigned char hello[18];
    const unsigned char *content;
    size_t length;
    const uint32_t nonce = (uint32_t)time(NULL) * 2654435761u ^ (uint32_t)getpid() << 8 ^ (uint32_t)now_ms();
    const int64_t until = now_ms() + client->timeout_ms;
    memset(hello, 0, sizeof hello);
    write_bits(hello + 4, 4, nonce);
    write_bits(hello + 8, 2, FLEXSC_VERSION);
    write_bits(hello + 10, 8, layout);
    for (int first = 1;; first = 0) {
        if ((first || client->transport == FLEXSC_UDP) && send_packet(client, HELLO, hello, sizeof hello) != 0) {
            return -1;
        }
        const int64_t again = now_ms() + HELLO_REPEAT_MS;
        while (now_ms() < again) {
            const int kind = receive_packet(client, again, &content, &length);
            if (kind < 0) {
                return -1;
            }
            if (kind == REFUSAL) {
                return refused(client, content, length);
            }
            if (kind == WELCOME && length > 19 && read_bits(content + 4, 4) == nonce) {
                client->session = (uint32_t)read_bits(content, 4);
                client->layout = read_bits(content + 10, 8);
                client->pace = content[18];
                char *text = (char *)client->received + HEADER + 19;
                client->received[HEADER + length] = '\0';
                return read_layout(client, text);
            }
        }
        if (now_ms() >= until) {
            return fail(client, "no server answers there: start `flexsc serve` first", "");
        }
    }
}

int flexsc_connect(flexsc_client *client, int transport, const char *host, uint16_t port, uint64_t layout)
{
    memset(client, 0, sizeof *client);
    client->transport = transport;
    client->timeout_ms = TIMEOUT_MS;
    client->socket = -1;
    if (open_socket(client, host, port) != 0 || greet(client, layout) != 0) {
        flexsc_close(client);
        return -1;
    }
    return 0;
}

int flexsc_receive(flexsc_client *client)
{
    unsigned char request[12];
    const uint64_t expected = client->has_cycle ? client->cycle + 1 : 0;
    const int64_t until = now_ms() + client->timeout_ms;
    const unsigned char *content;
    size_t length;
    write_bits(request, 4, client->session);
    write_bits(request + 4, 8, expected);
    if (client->pace == 2 && send_packet(client, REQUEST, request, sizeof request) != 0) {
        return -1;
    }
    for (;;) {
        const int requests = client->pace == 2 && client->transport == FLEXSC_UDP;
        const int kind = receive_packet(client, requests ? now_ms() + REPEAT_MS : until, &content, &length);
        if (kind < 0) {
            return -1;
        }
        if (kind == REFUSAL) {
            return refused(client, content, length);
        }
        if (kind == END && length == 29 && read_bits(content, 4) == client->session) {
            client->end = content[28];
            return send_packet(client, FAREWELL, request, 4) == 0 ? 0 : -1;
        }
        if (kind == SENSORS && length == client->content_length && read_bits(content, 4) == client->session) {
            const uint64_t cycle = read_bits(content + 4, 8);
            if (cycle == expected) {
                memcpy(client->content, content, length);
                client->cycle = cycle;
                client->time_s = as_signed(read_bits(content + 12, 8));
                client->time_fs = as_signed(read_bits(content + 20, 8));
                client->has_cycle = 1;
                client->answer_length = 0;
                return 1;
            }
            /* The answer was lost, or the packet is a repetition of one that was answered. */
            if (client->has_cycle && cycle == client->cycle && client->answer_length > 0
                && send_packet(client, COMMAND, client->answer, client->answer_length) != 0) {
                return -1;
            }
        }
        if (now_ms() >= until) {
            return fail(client, "the server is silent", "");
        }
        if (kind == 0 && requests && send_packet(client, REQUEST, request, sizeof request) != 0) {
            return -1;
        }
    }
}

int flexsc_find(const flexsc_client *client, const char *name)
{
    for (int field = 0; field < client->field_count; field++) {
        if (strcmp(client->fields[field].name, name) == 0) {
            return field;
        }
    }
    return -1;
}

/* Returns the bytes of a component; NULL if there is none. */
static const unsigned char *component_at(const flexsc_client *client, int field, int component, char *type)
{
    if (field < 0 || field >= client->field_count || component < 0 || component >= client->fields[field].count) {
        return NULL;
    }
    const flexsc_field *found = &client->fields[field];
    *type = found->type;
    return client->content + found->offset + size_of(found->type) * (size_t)component;
}

int64_t flexsc_integer(const flexsc_client *client, int field, int component)
{
    char type;
    const unsigned char *at = component_at(client, field, component, &type);
    return at && type != 'd' ? as_signed(read_bits(at, size_of(type))) : 0;
}

void flexsc_read(const flexsc_client *client, const char *name, double *numbers, int count)
{
    const int field = flexsc_find(client, name);
    for (int index = 0; index < count; index++) {
        numbers[index] = flexsc_number(client, field, index);
    }
}

int flexsc_is_new(const flexsc_client *client, const char *sensor)
{
    char name[64];
    snprintf(name, sizeof name, "%s.status", sensor);
    return flexsc_integer(client, flexsc_find(client, name), 0) == FLEXSC_NEW;
}

double flexsc_number(const flexsc_client *client, int field, int component)
{
    char type;
    double number;
    const unsigned char *at = component_at(client, field, component, &type);
    if (!at) {
        return (double)NAN;
    }
    const uint64_t bits = read_bits(at, size_of(type));
    if (type == 'd') {
        memcpy(&number, &bits, sizeof number);
        return number;
    }
    return type == 'i' ? (double)as_signed(bits) : (double)bits;
}

int flexsc_command_each(flexsc_client *client, const double *values, const int *quantities)
{
    if (!client->has_cycle) {
        return fail(client, "no cycle has been received yet", "");
    }
    const size_t axes = (size_t)client->axes;
    write_bits(client->answer, 4, client->session);
    write_bits(client->answer + 4, 8, client->cycle);
    for (size_t axis = 0; axis < axes; axis++) {
        uint64_t bits;
        memcpy(&bits, &values[axis], sizeof bits);
        client->answer[12 + axis] = (unsigned char)quantities[axis];
        write_bits(client->answer + 12 + axes + 8 * axis, 8, bits);
    }
    client->answer_length = 12 + 9 * axes;
    return send_packet(client, COMMAND, client->answer, client->answer_length);
}

int flexsc_command(flexsc_client *client, const double *values, int quantity)
{
    const int quantities[3] = {quantity, quantity, quantity};
    return flexsc_command_each(client, values, quantities);
}

int flexsc_hold(flexsc_client *client)
{
    const double none[3] = {0.0, 0.0, 0.0};
    return flexsc_command(client, none, FLEXSC_HOLD);
}

void flexsc_close(flexsc_client *client)
{
    if (client->socket >= 0) {
        close(client->socket);
    }
    client->socket = -1;
}
