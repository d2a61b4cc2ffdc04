// The table of commands and lamps, as `vantage control --json` prints it; `npm run table` writes it.
import table from './table.json' with { type: 'json' }

export interface VantageCommand {
	name: string
	does: string
	/** The largest number of its argument; absent: it takes none. */
	number?: number
	/** The name of its argument of words. */
	words?: string
	/** The largest number of steps, if it takes steps of a wheel, either way. */
	steps?: number
	lamp?: string
}

export interface VantageLamp {
	name: string
	says: string
	kind: 'switch' | 'number' | 'word'
}

interface Row {
	[key: string]: unknown
}

const text = (row: Row, key: string): string => (typeof row[key] === 'string' ? row[key] : '')

export const commands: VantageCommand[] = (table.commands as Row[]).map((row) => ({
	name: text(row, 'name'),
	does: text(row, 'does'),
	number: typeof row.most === 'number' ? row.most : undefined,
	words: typeof row.words === 'string' ? row.words : undefined,
	steps: typeof row.most_steps === 'number' ? row.most_steps : undefined,
	lamp: text(row, 'lamp'),
}))

export const lamps: VantageLamp[] = (table.lamps as Row[]).map((row) => ({
	name: text(row, 'name'),
	says: text(row, 'says'),
	kind: text(row, 'is') as VantageLamp['kind'],
}))
