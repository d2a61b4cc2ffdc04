// Writes src/table.json, the table of commands and lamps, as the program prints it. VANTAGE names the program.
import { execFileSync } from 'node:child_process'
import { writeFileSync } from 'node:fs'

const table = JSON.parse(execFileSync(process.env.VANTAGE ?? 'vantage', ['control', '--json'], { encoding: 'utf8' }))
if (!table.commands?.length || !table.lamps?.length) throw new Error('vantage control --json has no commands or lamps')
writeFileSync(new URL('../src/table.json', import.meta.url), JSON.stringify(table, null, '\t') + '\n')
