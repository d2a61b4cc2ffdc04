/* irq_to_desc() is not exported to modules. */
#include <linux/irq.h>
#include <linux/irqdesc.h>
#define irq_to_desc(n) irq_data_to_desc(irq_get_irq_data(n))
