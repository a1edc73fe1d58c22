{{/* The names and labels of everything; the release's own name is in them once. */}}
{{- define "terrane.name" -}}
{{- if contains "terrane" .Release.Name }}{{ .Release.Name | trunc 52 | trimSuffix "-" }}
{{- else }}{{ printf "%s-terrane" .Release.Name | trunc 52 | trimSuffix "-" }}{{ end }}
{{- end }}

{{/* What selects the replicas, and not the pods of an export. */}}
{{- define "terrane.selector" -}}
app.kubernetes.io/name: terrane
app.kubernetes.io/instance: {{ .Release.Name }}
app.kubernetes.io/component: server
{{- end }}

{{- define "terrane.labels" -}}
app.kubernetes.io/name: terrane
app.kubernetes.io/instance: {{ .Release.Name }}
app.kubernetes.io/version: {{ .Chart.AppVersion | quote }}
app.kubernetes.io/managed-by: {{ .Release.Service }}
helm.sh/chart: {{ printf "%s-%s" .Chart.Name .Chart.Version }}
{{- end }}

{{/* The name of an image of the values: (list $ .Values.image). */}}
{{- define "terrane.image" -}}
{{- $chart := (index . 0).Chart }}
{{- with index . 1 }}
{{- if .digest }}{{ .repository }}@{{ .digest }}
{{- else }}{{ .repository }}:{{ .tag | default $chart.AppVersion }}{{ end }}
{{- end }}
{{- end }}

{{- define "terrane.serviceAccount" -}}
{{ .Values.serviceAccount.name | default (include "terrane.name" .) }}
{{- end }}

{{/* Nobody's user, without a capability, with a root that cannot be written. */}}
{{- define "terrane.podSecurity" -}}
runAsNonRoot: true
runAsUser: 65532
runAsGroup: 65532
fsGroup: 65532
seccompProfile:
  type: RuntimeDefault
{{- end }}

{{- define "terrane.containerSecurity" -}}
allowPrivilegeEscalation: false
readOnlyRootFilesystem: true
capabilities:
  drop: [ALL]
{{- end }}
