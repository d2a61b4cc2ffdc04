// The module against a real `vantage play`: a press becomes a command, and a lamp becomes a variable and a feedback.
// The module talks to Companion through the context that the package's host-api describes; here the test is the host.
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import { createSocket } from 'node:dgram'
import { copyFileSync, mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { after, before, test } from 'node:test'
import { isInstanceContext } from '@companion-module/base/host-api'
import VantageInstance, { UpgradeScripts } from '../dist/main.js'
import { decodeOsc, encodeOsc } from '../dist/osc.js'
import { commands, lamps } from '../dist/table.js'

const VANTAGE = process.env.VANTAGE ?? 'vantage'
const TAKE = process.env.VANTAGE_TAKE

/** What Companion would hold of a connection. */
class Host {
	_isInstanceContext = true
	id = 'test'
	label = 'vantage'
	upgradeScripts = UpgradeScripts
	sharedUdpSocketHandlers = new Map()
	actions = {}
	feedbacks = {}
	presets = {}
	structure = []
	variables = {}
	values = {}
	status = undefined
	checked = []
	#waiting = []

	#changed() {
		this.#waiting = this.#waiting.filter(([is, resolve]) => !is() || resolve())
	}
	/** Waits until `is` holds. */
	until(is, what) {
		if (is()) return Promise.resolve()
		return new Promise((resolve, reject) => {
			const timer = setTimeout(() => reject(new Error(`not within 20 s: ${what}`)), 20_000)
			this.#waiting.push([is, () => (clearTimeout(timer), resolve(), false)])
		})
	}
	updateStatus(status, message) {
		this.status = { status, message }
		this.#changed()
	}
	setActionDefinitions(actions) {
		this.actions = actions
	}
	setFeedbackDefinitions(feedbacks) {
		this.feedbacks = feedbacks
	}
	setPresetDefinitions(structure, presets) {
		Object.assign(this, { structure, presets })
	}
	setVariableDefinitions(variables) {
		this.variables = variables
	}
	setVariableValues(values) {
		Object.assign(this.values, values)
		this.#changed()
	}
	checkFeedbacks(ids) {
		this.checked.push(...ids)
	}
	press(actionId, options = {}) {
		return this.actions[actionId].callback({ actionId, options }, {})
	}
	shows(feedbackId) {
		return this.feedbacks[feedbackId].callback({ feedbackId, options: {} }, {})
	}
}

async function freePort() {
	const socket = createSocket('udp4')
	await new Promise((resolve) => socket.bind(0, '127.0.0.1', resolve))
	const { port } = socket.address()
	await new Promise((resolve) => socket.close(resolve))
	return port
}

const host = new Host()
let instance, show, port, folder
before(async () => {
	port = await freePort()
	// The show keeps its clips beside the take.
	folder = mkdtempSync(join(tmpdir(), 'vantage-'))
	const take = join(folder, 'take.mkv')
	copyFileSync(TAKE, take)
	show = spawn(
		VANTAGE,
		[
			'play',
			take,
			'--headless',
			'--size',
			'96x72',
			'--speed',
			'0',
			'--rate',
			'50',
			'--seconds',
			'600',
			'--control',
			`osc://127.0.0.1:${port}`,
		],
		{ stdio: 'ignore' },
	)
	assert.ok(isInstanceContext(host))
	instance = new VantageInstance(host)
	await instance.init({ host: '127.0.0.1', port }, true, undefined)
})
after(async () => {
	await instance?.destroy()
	if (show?.exitCode === null) {
		const ended = new Promise((resolve) => show.once('exit', resolve))
		show.kill('SIGINT')
		await ended
	}
	rmSync(folder, { recursive: true })
})

test('OSC messages come back', () => {
	for (const values of [[], [3], [-2.5, 'ab'], ['four', 'ünï']])
		assert.deepEqual(decodeOsc(encodeOsc('/vantage/a', values)), { address: '/vantage/a', values })
	assert.equal(decodeOsc(Buffer.from('nothing')), undefined)
	assert.equal(decodeOsc(encodeOsc('/a', [1]).subarray(0, 9)), undefined)
})

test('every command is an action, every lamp a variable, every switch a feedback', () => {
	assert.ok(commands.length > 60)
	assert.deepEqual(Object.keys(host.actions).sort(), commands.map((each) => each.name).sort())
	assert.equal(Object.keys(host.variables).length, lamps.length)
	assert.deepEqual(
		Object.keys(host.feedbacks).sort(),
		lamps
			.filter((each) => each.kind === 'switch')
			.map((each) => each.name)
			.sort(),
	)
	assert.equal(host.actions.shot.options[0].max, 9)
	assert.equal(host.actions.orbit.options[0].min, -360)
})

test('presets name actions and feedbacks that exist', () => {
	const listed = host.structure.flatMap((section) => section.definitions.flatMap((group) => group.presets))
	assert.deepEqual(listed.sort(), Object.keys(host.presets).sort())
	assert.match(host.presets.air_verdict.style.text, /\$\(vantage:verdict\)/)
	assert.ok(host.variables.verdict && host.variables.verdict_reason)
	assert.ok(listed.includes('shot_9') && listed.includes('cut') && listed.includes('take'))
	for (const preset of Object.values(host.presets)) {
		for (const { actionId } of preset.steps[0].down) assert.ok(host.actions[actionId], actionId)
		for (const { feedbackId } of preset.feedbacks) assert.ok(host.feedbacks[feedbackId], feedbackId)
	}
})

// The show opens its port after it has loaded the take: subscribe until it answers.
test('lamps become variables and feedbacks', async () => {
	const again = setInterval(() => void instance.configUpdated({ host: '127.0.0.1', port }), 2000)
	try {
		await host.until(() => host.status?.status === 'ok', 'lamps')
	} finally {
		clearInterval(again)
	}
	await host.until(() => host.values.hold === true, 'the show is held')
	assert.equal(host.shows('hold'), true)
	assert.equal(host.shows('live'), false)
	assert.ok(host.checked.includes('hold'))
	await host.until(() => /^(ready|caution|not_ready)$/.test(host.values.verdict), 'the air verdict')
	assert.equal(host.shows('ready'), host.values.verdict === 'ready')
	await host.until(() => /^\d\d:\d\d:\d\d/.test(host.values.timecode ?? ''), 'time code')
})

test('a press becomes a command', async () => {
	await host.press('mark_in')
	await host.until(() => host.values.mark_in === true, 'the in mark')
	assert.equal(host.shows('mark_in'), true)
	await host.press('no_marks')
	await host.until(() => host.values.mark_in === false, 'no in mark')
	await host.press('preset', { number: 40 })
	await host.until(() => host.values.preset === 40, 'the programme speed')
	const code = host.values.timecode
	await host.press('cue_time', { words: '1' })
	await host.until(() => host.values.timecode !== code, 'another time')
})

const shown = (times) => {
	times.sort((a, b) => a - b)
	return `median ${times[times.length >> 1].toFixed(1)} ms, longest ${times.at(-1).toFixed(1)} ms`
}

// The way of a press to the command in the show: from the key to the datagram, and through the port, which answers a
// subscription at once.
test('a press reaches the show soon', async (context) => {
	const socket = createSocket('udp4')
	await new Promise((resolve) => socket.bind(0, '127.0.0.1', resolve))
	const message = () => new Promise((resolve) => socket.once('message', (datagram) => resolve(decodeOsc(datagram))))
	await instance.configUpdated({ host: '127.0.0.1', port: socket.address().port })
	const sent = [],
		answered = []
	for (let i = 0; i < 50; ++i) {
		let next = message()
		const before = performance.now()
		await host.press('mark_in')
		while ((await next).address !== '/vantage/mark_in') next = message()
		sent.push(performance.now() - before)
	}
	socket.close()
	// A show has few subscribers at a time, so only some new ones are tried.
	for (let i = 0; i < 3; ++i) {
		const subscriber = createSocket('udp4')
		await new Promise((resolve) => subscriber.bind(0, '127.0.0.1', resolve))
		const answer = new Promise((resolve) => subscriber.once('message', resolve))
		const before = performance.now()
		subscriber.send(encodeOsc('/vantage/subscribe', []), port, '127.0.0.1')
		assert.match(decodeOsc(await answer).address, /^\/vantage\/lamp\//)
		answered.push(performance.now() - before)
		subscriber.close()
	}
	await instance.configUpdated({ host: '127.0.0.1', port })
	context.diagnostic(`from the press to its datagram: ${shown(sent)}`)
	context.diagnostic(`from a datagram to the answer of the show: ${shown(answered)}`)
})

test('presses take little time', async (context) => {
	const times = []
	for (let i = 0; i < 20; ++i) {
		const before = performance.now()
		await host.press(i % 2 ? 'no_marks' : 'mark_in')
		await host.until(() => host.values.mark_in === (i % 2 === 0), 'the mark')
		times.push(performance.now() - before)
	}
	context.diagnostic(`from the press to the lamp: ${shown(times)}`)
})

test('a wrong port is told', async () => {
	await instance.configUpdated({ host: '', port: 0 })
	assert.equal(host.status.status, 'bad_config')
})
