import { createSocket, type RemoteInfo, type Socket } from 'node:dgram'
import {
	type CompanionActionDefinition,
	type CompanionActionDefinitions,
	type CompanionFeedbackDefinitions,
	type CompanionPresetDefinitions,
	type CompanionPresetSection,
	InstanceBase,
	InstanceStatus,
	type SomeCompanionConfigField,
} from '@companion-module/base'
import { decodeOsc, encodeOsc, type OscValue } from './osc.js'
import { commands, lamps, type VantageCommand } from './table.js'

const ROOT = '/vantage/'
const LAMP_ROOT = ROOT + 'lamp/'
/** Vantage serves a subscription for a minute. */
const SUBSCRIBE_MS = 15_000
/** Vantage sends all lamps every two seconds. */
const SILENCE_MS = 6_000

const WHITE = 0xffffff
const BLACK = 0x000000
const GREY = 0x2b313b
const AMBER = 0xb07000
const RED = 0xc01818
const GREEN = 0x1d7a46

export type VantageConfig = { host: string; port: number }
type Options = { number: number; words: string }
export type VantageTypes = {
	config: VantageConfig
	secrets: undefined
	actions: Record<string, { options: Partial<Options> }>
	feedbacks: Record<string, { type: 'boolean'; options: Record<string, never> }>
	variables: Record<string, OscValue | boolean | undefined>
}

/** The id of a lamp as variable and feedback: "output/1" is output_1. */
const idOf = (lamp: string): string => lamp.replaceAll('/', '_')
const titleOf = (name: string): string => name.replaceAll('_', ' ').replaceAll('/', ' ')

export default class VantageInstance extends InstanceBase<VantageTypes> {
	#socket: Socket | undefined
	#config: VantageConfig = { host: '127.0.0.1', port: 9000 }
	#subscription: NodeJS.Timeout | undefined
	#heard = 0
	readonly #values = new Map<string, OscValue | boolean>()

	async init(config: VantageConfig): Promise<void> {
		this.setActionDefinitions(this.#actions())
		this.setFeedbackDefinitions(this.#feedbacks())
		this.setVariableDefinitions(
			Object.fromEntries(lamps.map((lamp) => [idOf(lamp.name), { name: lamp.says || titleOf(lamp.name) }])),
		)
		this.#setPresets()
		await this.configUpdated(config)
	}

	async destroy(): Promise<void> {
		clearInterval(this.#subscription)
		this.#socket?.close()
		this.#socket = undefined
	}

	async configUpdated(config: VantageConfig): Promise<void> {
		await this.destroy()
		this.#config = config
		this.#values.clear()
		if (!config.host || !config.port) {
			this.updateStatus(InstanceStatus.BadConfig, 'enter the host and the port of --control osc://HOST:PORT')
			return
		}
		this.updateStatus(InstanceStatus.Connecting)
		const socket = createSocket('udp4')
		this.#socket = socket
		socket.on('message', (datagram: Buffer, from: RemoteInfo) => this.#take(datagram, from))
		socket.on('error', (error) => this.updateStatus(InstanceStatus.ConnectionFailure, error.message))
		await new Promise<void>((resolve) => socket.bind(0, resolve))
		const subscribe = () => {
			this.#send(ROOT + 'subscribe', [])
			if (this.#heard && Date.now() - this.#heard > SILENCE_MS) {
				this.#heard = 0
				this.updateStatus(InstanceStatus.Disconnected, 'Vantage sends no lamps')
			}
		}
		this.#heard = 0
		subscribe()
		this.#subscription = setInterval(subscribe, SUBSCRIBE_MS)
	}

	getConfigFields(): SomeCompanionConfigField[] {
		return [
			{ type: 'textinput', id: 'host', label: 'Host of vantage live or play', width: 8, default: '127.0.0.1' },
			{ type: 'number', id: 'port', label: 'Port of --control osc://', width: 4, min: 1, max: 65535, default: 9000 },
		]
	}

	#send(address: string, values: OscValue[]): void {
		this.#socket?.send(encodeOsc(address, values), this.#config.port, this.#config.host, (error) => {
			if (error) this.updateStatus(InstanceStatus.ConnectionFailure, error.message)
		})
	}

	#take(datagram: Buffer, from: RemoteInfo): void {
		const message = decodeOsc(datagram)
		if (from.port !== this.#config.port || !message?.address.startsWith(LAMP_ROOT)) return
		if (!this.#heard) this.updateStatus(InstanceStatus.Ok)
		this.#heard = Date.now()
		const lamp = lamps.find((each) => each.name === message.address.slice(LAMP_ROOT.length))
		const value = message.values[0]
		if (!lamp || value === undefined) return
		const id = idOf(lamp.name)
		const shown = lamp.kind === 'switch' ? value !== 0 : value
		if (this.#values.get(id) === shown) return
		this.#values.set(id, shown)
		this.setVariableValues({ [id]: shown })
		if (lamp.kind === 'switch') this.checkFeedbacks(id)
	}

	#action(command: VantageCommand): CompanionActionDefinition<Partial<Options>> {
		const options: CompanionActionDefinition<Partial<Options>>['options'] = []
		if (command.number !== undefined)
			options.push({ type: 'number', id: 'number', label: 'Number', min: 1, max: command.number, default: 1 })
		if (command.steps !== undefined)
			options.push({
				type: 'number',
				id: 'number',
				label: 'Steps',
				min: -command.steps,
				max: command.steps,
				default: 1,
			})
		if (command.words !== undefined)
			options.push({ type: 'textinput', id: 'words', label: titleOf(command.words).toLowerCase() })
		return {
			name: titleOf(command.name),
			description: command.does,
			options,
			callback: ({ options: given }) => {
				const values: OscValue[] = []
				if (command.number !== undefined || command.steps !== undefined) values.push(Number(given.number ?? 1))
				if (command.words !== undefined) values.push(String(given.words ?? ''))
				this.#send(ROOT + command.name, values)
			},
		}
	}

	#actions(): CompanionActionDefinitions<VantageTypes['actions']> {
		return Object.fromEntries(commands.map((command) => [command.name, this.#action(command)]))
	}

	#feedbacks(): CompanionFeedbackDefinitions<VantageTypes['feedbacks']> {
		return Object.fromEntries(
			lamps
				.filter((lamp) => lamp.kind === 'switch')
				.map((lamp) => [
					idOf(lamp.name),
					{
						type: 'boolean' as const,
						name: titleOf(lamp.name),
						description: lamp.says,
						defaultStyle: { bgcolor: AMBER, color: WHITE },
						options: [],
						callback: () => this.#values.get(idOf(lamp.name)) === true,
					},
				]),
		)
	}

	#setPresets(): void {
		const presets: CompanionPresetDefinitions<VantageTypes> = {}
		const structure: CompanionPresetSection<VantageTypes>[] = []
		const section = (name: string, keys: [string, string, string, number?, number?][]) => {
			const ids: string[] = []
			for (const [command, words, lamp, colour, number] of keys) {
				const id = number === undefined ? command : `${command}_${number}`
				ids.push(id)
				presets[id] = {
					type: 'simple',
					name: words.replace('\n', ' '),
					style: { text: words, size: 'auto', color: WHITE, bgcolor: command === 'empty' ? BLACK : GREY },
					steps: [{ down: [{ actionId: command, options: number === undefined ? {} : { number } }], up: [] }],
					feedbacks: lamp ? [{ feedbackId: lamp, options: {}, style: { bgcolor: colour ?? AMBER, color: WHITE } }] : [],
				}
			}
			const id = name.toLowerCase()
			structure.push({ id, name, definitions: [{ id: id + '_keys', type: 'simple', name, presets: ids }] })
		}
		section('Transport', [
			['live', 'Live', 'live', GREEN],
			['freeze', 'Hold', 'hold'],
			['frame_back', '◀\nframe', ''],
			['frame_on', 'frame\n▶', ''],
			['slower', 'Slower', ''],
			['faster', 'Faster', ''],
			['play_list', 'Play\nlist', ''],
			['take', 'Take', 'take', RED],
		])
		section('Marks', [
			['mark_in', 'Mark\nin', 'mark_in'],
			['mark_out', 'Mark\nout', 'mark_out'],
			['no_marks', 'No\nmarks', ''],
			['loop', 'Loop', 'loop'],
			['cue', 'To in\nmark', ''],
			['make_clip', 'Make\nclip', ''],
		])
		section('Camera', [
			...Array.from({ length: 9 }, (_, i): [string, string, string, undefined, number] => [
				'shot',
				`Shot\n${i + 1}`,
				'',
				undefined,
				i + 1,
			]),
			['cut', 'Cut', ''],
			['auto', 'Auto', ''],
			['play', 'Move', ''],
			['reset', 'Start\nview', ''],
		])
		// A key that shows whether the programme may go on air, and does nothing.
		presets['air_verdict'] = {
			type: 'simple',
			name: 'Air verdict',
			style: { text: `Air\n$(${this.label}:verdict)`, size: 'auto', color: WHITE, bgcolor: RED },
			steps: [{ down: [], up: [] }],
			feedbacks: [{ feedbackId: 'ready', options: {}, style: { bgcolor: GREEN, color: WHITE } }],
		}
		structure.push({
			id: 'air',
			name: 'Air',
			definitions: [{ id: 'air_keys', type: 'simple', name: 'Air', presets: ['air_verdict'] }],
		})
		this.setPresetDefinitions(structure, presets)
	}
}

export const UpgradeScripts = []
