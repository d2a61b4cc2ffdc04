// Open Sound Control 1.0: messages of numbers and words, as Vantage sends and reads them.

export type OscValue = number | string

const padded = (bytes: number): number => Math.ceil((bytes + 1) / 4) * 4

function encodeText(text: string): Buffer {
	const bytes = Buffer.from(text, 'utf8')
	const buffer = Buffer.alloc(padded(bytes.length))
	bytes.copy(buffer)
	return buffer
}

/** A message; whole numbers are sent as int32, others as float32. */
export function encodeOsc(address: string, values: OscValue[]): Buffer {
	let types = ','
	const parts: Buffer[] = []
	for (const value of values) {
		if (typeof value === 'string') {
			types += 's'
			parts.push(encodeText(value))
			continue
		}
		const buffer = Buffer.alloc(4)
		if (Number.isInteger(value)) {
			types += 'i'
			buffer.writeInt32BE(value)
		} else {
			types += 'f'
			buffer.writeFloatBE(value)
		}
		parts.push(buffer)
	}
	return Buffer.concat([encodeText(address), encodeText(types), ...parts])
}

export interface OscMessage {
	address: string
	values: OscValue[]
}

/** The message in a datagram; undefined if it is malformed or has other types. */
export function decodeOsc(datagram: Buffer): OscMessage | undefined {
	let at = 0
	const text = (): string | undefined => {
		const end = datagram.indexOf(0, at)
		if (end < 0) return undefined
		const words = datagram.toString('utf8', at, end)
		at += padded(end - at)
		return words
	}
	const address = text()
	const types = text()
	if (!address?.startsWith('/') || !types?.startsWith(',')) return undefined
	const values: OscValue[] = []
	for (const type of types.slice(1)) {
		if (type === 's') {
			const words = text()
			if (words === undefined) return undefined
			values.push(words)
		} else if (type === 'i' || type === 'f') {
			if (at + 4 > datagram.length) return undefined
			values.push(type === 'i' ? datagram.readInt32BE(at) : datagram.readFloatBE(at))
			at += 4
		} else return undefined
	}
	return { address, values }
}
