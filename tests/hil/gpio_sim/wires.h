/*
 * Wires for gpio-sim: an even line that is driven pulls the odd line after it, whose edges the
 * kernel then stamps as it would those of a real input. prepare.sh puts this at the end of
 * gpio-sim.c and lets the chip call the *_wired functions.
 */
static void gpio_sim_wire(struct gpio_chip* gc, unsigned int offset, int value) {
    if (offset % 2 == 0 && offset + 1 < gc->ngpio)
        gpio_sim_apply_pull(gpiochip_get_data(gc), offset + 1, value);
}

static void gpio_sim_set_wired(struct gpio_chip* gc, unsigned int offset, int value) {
    gpio_sim_set(gc, offset, value);
    gpio_sim_wire(gc, offset, value);
}

static void gpio_sim_set_multiple_wired(struct gpio_chip* gc, unsigned long* mask,
                                        unsigned long* bits) {
    unsigned int offset;

    gpio_sim_set_multiple(gc, mask, bits);
    for_each_set_bit(offset, mask, gc->ngpio) gpio_sim_wire(gc, offset, test_bit(offset, bits));
}

static int gpio_sim_direction_output_wired(struct gpio_chip* gc, unsigned int offset, int value) {
    int ret = gpio_sim_direction_output(gc, offset, value);

    gpio_sim_wire(gc, offset, value);
    return ret;
}
