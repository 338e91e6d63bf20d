/* The exported control system of scenarios/cubesat-day.toml, or of another CubeSat with detumbling, as the flight software of a run in
 * lockstep:
 *
 *     flexsc export-c scenarios/cubesat-day.toml -o flight --name sat
 *     make -C clients/c cubesat FLIGHT=../../flight
 *     flexsc serve scenarios/cubesat-day.toml --period 0.5
 *     clients/c/cubesat 127.0.0.1 5010 udp 30000
 *
 * Attitude filter, modes and laws are those of the export. Moments of B-dot and torques go to the actuators of the server, where the
 * scenario's law unloads the wheels; targets are those of the server's modes. The rows of the log are those of `flexsc simulate` to the
 * last bit. With -DTRACKER_MODES=0x6 it is that of scenarios/safe-mode.toml, with -DTRACKER_MODES=0 of detumble-and-point.toml.
 *
 * Arguments: host, port, transport, and the time at which the computer fails for 10 s. Then it begins with the readings, and with what a
 * computer keeps: the mode, how often each was entered, and the time of the start. */
#include "flexsc_lockstep.h"
#include "sat.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Time without the computer (s). */
#define OUTAGE 10

/* Modes in which the star tracker is in use, one bit each; none without one. */
#ifndef TRACKER_MODES
#define TRACKER_MODES 0x1f
#endif

/* Mode in which the B-dot law commands the magnetorquers. */
#define DETUMBLE 0

static flexsc_client client;
static sat_state state;
/* Times of the next test of the conditions, of the next decision and of the last reading of the star tracker. */
static sat_ticks next_test, next_step;
static sat_ticks period;
static int64_t mode;
#if TRACKER_MODES
/* Time of its last reading, or at which it came into use. */
static sat_ticks last_tracker;
#endif
/* Kept through a failure: the supervisor with the time of the start, and the modes with their entries. */
static sat_state kept;

static bool is_before(sat_ticks a, sat_ticks b)
{
    return a.whole < b.whole || (a.whole == b.whole && a.part < b.part);
}

/* Begins, at the start of the run or after the computer has failed. */
static void begin(sat_ticks now)
{
    sat_start_input start = sat_run_start;
    sat_start_output started;
    memset(&state, 0x5a, sizeof state);
    sat_init(&state, now);
#if TRACKER_MODES
    if (client.cycle > 0) {
        memset(&start, 0, sizeof start);
        flexsc_read(&client, "star_tracker.attitude", start.attitude, 4);
    }
#endif
    sat_start(&state, now, &start, &started);
    if (client.cycle > 0) {
        const sat_enter_input input = {.mode = mode};
        sat_enter_output entered;
        sat_enter(&state, now, &input, &entered);
        state.supervisor.started = kept.supervisor.started;
        memcpy(state.modes, kept.modes, sizeof state.modes);
    }
    next_test = now;
    next_step = now;
}

/* Gives the filter and the B-dot law the readings that have come since the last cycle. */
static void sample(sat_ticks now)
{
    sat_sample_input input = {.gyro_is_valid = flexsc_is_new(&client, "gyro"),
                              .magnetometer_is_valid = flexsc_is_new(&client, "magnetometer"),
                              .sun_sensor_is_valid = flexsc_is_new(&client, "sun_sensor")};
    sat_sample_output output;
#if TRACKER_MODES
    input.star_tracker_is_valid = flexsc_is_new(&client, "star_tracker");
    if (input.star_tracker_is_valid) {
        last_tracker = now;
    }
    flexsc_read(&client, "star_tracker.attitude", input.star_tracker_attitude, 4);
#endif
    flexsc_read(&client, "gyro.rate", input.gyro_rate, 3);
    flexsc_read(&client, "magnetometer.field", input.magnetometer_vector, 3);
    flexsc_read(&client, "magnetometer.reference", input.magnetometer_reference, 3);
    flexsc_read(&client, "sun_sensor.direction", input.sun_sensor_vector, 3);
    flexsc_read(&client, "sun_sensor.reference", input.sun_sensor_reference, 3);
    sat_sample(&state, now, &input, &output);
    if (input.magnetometer_is_valid) {
        sat_field_input field;
        sat_field_output rate;
        memcpy(field.field, input.magnetometer_vector, sizeof field.field);
        sat_field(&state, now, &field, &rate);
    }
}

/* Tests the conditions of the mode. */
static void supervise(sat_ticks now)
{
    sat_supervise_input input;
    sat_supervise_output output;
    memset(&input, 0, sizeof input);
#if TRACKER_MODES
    flexsc_read(&client, "conditions.attitude", input.target_attitude, 4);
    input.silent_star_tracker = (double)(now.whole - last_tracker.whole) + (double)(now.part - last_tracker.part) * 1e-15;
#endif
    sat_supervise(&state, now, &input, &output);
    if (output.has_changed) {
        printf("mode %d at %lld s\n", (int)output.mode, (long long)now.whole);
        next_step = now;
#if TRACKER_MODES
        if ((TRACKER_MODES >> mode & 1) == 0) {
            last_tracker = now;
        }
#endif
    }
    mode = output.mode;
    period.whole = output.period_whole;
    period.part = output.period_part;
    next_test.whole = output.has_next ? output.next_whole : INT64_MAX;
    next_test.part = output.next_part;
}

/* Decides, and sends the moments or the torques. */
static int step(sat_ticks now)
{
    sat_step_input input;
    sat_step_output output;
    flexsc_read(&client, "reference.attitude", input.target_attitude, 4);
    flexsc_read(&client, "reference.angle", input.reference_angle, 3);
    flexsc_read(&client, "reference.rate", input.reference_rate, 3);
    flexsc_read(&client, "reference.acceleration", input.reference_acceleration, 3);
    flexsc_read(&client, "wheels.speed", input.wheel_speed, 3);
    sat_step(&state, now, &input, &output);
    next_step.whole = now.whole + period.whole;
    next_step.part = now.part + period.part;
    if (next_step.part >= INT64_C(1000000000000000)) {
        next_step.part -= INT64_C(1000000000000000);
        next_step.whole += 1;
    }
    if (output.mode == DETUMBLE) {
        return flexsc_command(&client, output.moment, FLEXSC_MOMENT);
    }
    return flexsc_command(&client, output.torque, FLEXSC_TORQUE);
}

int main(int count, char **arguments)
{
    const char *host = count > 1 ? arguments[1] : "127.0.0.1";
    const uint16_t port = (uint16_t)(count > 2 ? strtoul(arguments[2], NULL, 10) : 5010);
    const int transport = count > 3 && strcmp(arguments[3], "tcp") == 0 ? FLEXSC_TCP : FLEXSC_UDP;
    const int64_t failure = count > 4 ? strtoll(arguments[4], NULL, 10) : INT64_MAX - OUTAGE;
    if (failure <= 0) {
        fprintf(stderr, "error: the time of the failure must be above 0 s, got %s\n", arguments[4]);
        return 2;
    }
    if (flexsc_connect(&client, transport, host, port, 0) != 0) {
        fprintf(stderr, "error: %s\n", client.error);
        return 1;
    }
    bool is_up = false;
    int status;
    while ((status = flexsc_receive(&client)) == 1) {
        const sat_ticks now = {.whole = client.time_s, .part = client.time_fs};
        const bool has_failed = now.whole >= failure && now.whole < failure + OUTAGE;
        if (!is_up && !has_failed) {
            begin(now);
        }
        if (is_up && has_failed) {
            kept = state;
        }
        is_up = !has_failed;
        int sent;
        if (is_up) {
            sample(now);
            if (!is_before(now, next_test)) {
                supervise(now);
            }
            sent = is_before(now, next_step) ? flexsc_hold(&client) : step(now);
        } else {
            sent = flexsc_hold(&client);
        }
        if (sent != 0) {
            status = -1;
            break;
        }
    }
    if (status < 0) {
        fprintf(stderr, "error: %s\n", client.error);
    } else {
        printf("%llu cycles, %s\n", (unsigned long long)client.cycle + 1, client.end == FLEXSC_COMPLETE ? "complete" : "not complete");
    }
    flexsc_close(&client);
    return status < 0 || client.end == FLEXSC_FAILED;
}
