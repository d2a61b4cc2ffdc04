// The package that Companion imports: its manifest, and a module that has what the program has now.
import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { after, test } from 'node:test'
import { pathToFileURL } from 'node:url'
import { validateManifest } from '@companion-module/base/manifest'

const folder = mkdtempSync(join(tmpdir(), 'vantage-package-'))
after(() => rmSync(folder, { recursive: true }))
execFileSync('tar', ['-xzf', process.env.VANTAGE_PACKAGE, '-C', folder, '--strip-components=1'])
const manifest = JSON.parse(readFileSync(join(folder, 'companion', 'manifest.json'), 'utf8'))
const own = JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8'))
const version = (name) =>
	JSON.parse(readFileSync(new URL(`../node_modules/${name}/package.json`, import.meta.url), 'utf8')).version

test('its manifest is what Companion accepts', () => {
	validateManifest(manifest, false)
	assert.equal(manifest.version, own.version)
	assert.equal(manifest.runtime.apiVersion, version('@companion-module/base'))
	assert.equal(manifest.runtime.type, 'node22')
	assert.ok(existsSync(join(folder, 'companion', 'HELP.md')))
	assert.ok(process.env.VANTAGE_PACKAGE.endsWith(`${manifest.id}-${manifest.version}.tgz`))
})

test('it has the commands and lamps of the program', async () => {
	const table = JSON.parse(execFileSync(process.env.VANTAGE, ['control', '--json'], { encoding: 'utf8' }))
	const entry = join(folder, 'companion', manifest.runtime.entrypoint)
	const { default: Module, UpgradeScripts } = await import(pathToFileURL(entry))
	const shown = {}
	const instance = new Module({
		_isInstanceContext: true,
		id: 'test',
		label: 'vantage',
		upgradeScripts: UpgradeScripts,
		sharedUdpSocketHandlers: new Map(),
		updateStatus: (status) => (shown.status = status),
		setActionDefinitions: (actions) => (shown.actions = actions),
		setFeedbackDefinitions: (feedbacks) => (shown.feedbacks = feedbacks),
		setPresetDefinitions: () => {},
		setVariableDefinitions: (variables) => (shown.variables = variables),
		setVariableValues: () => {},
		checkFeedbacks: () => {},
	})
	await instance.init({ host: '', port: 0 }, true, undefined)
	assert.equal(shown.status, 'bad_config')
	assert.deepEqual(
		Object.entries(shown.actions).map(([name, action]) => [name, action.description, action.options[0]?.max]),
		table.commands.map((command) => [command.name, command.does, command.most ?? command.most_steps]),
	)
	assert.deepEqual(
		Object.keys(shown.variables),
		table.lamps.map((lamp) => lamp.name.replaceAll('/', '_')),
	)
	assert.deepEqual(
		Object.keys(shown.feedbacks),
		table.lamps.filter((lamp) => lamp.is === 'switch').map((lamp) => lamp.name),
	)
})
